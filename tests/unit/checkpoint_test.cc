// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints as files: what is on the disk, and what is made of it when it is not as it was written.
#include <gemmule/application/checkpoints.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/output/checkpoint_directory.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/named_arrays.h>

#include <limits>

#include "support/output_test.h"

using namespace Gemmule;

namespace
{
class CheckpointTest : public OutputTest
{
protected:
  void SetUp() override
  {
    OutputTest::SetUp();
    checkpoints = std::make_unique<CheckpointDirectory>(directory);
  }

  /** Writes a checkpoint with two files. */
  void write(const std::string &time, const unsigned int number_kept = 2)
  {
    const std::string place = checkpoints->begin();
    std::ofstream(place + "/state.h5") << "state at " << time << std::string(1000, 'x');
    std::ofstream(place + "/parameters.prm") << "set End time = 1\n";
    checkpoints->complete({{"time", time}, {"command_line", "gemmule a = b"}}, number_kept);
  }

  void overwrite(const std::string &name, const std::string &text) const
  {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  /** Time of the newest good one ("none" if there is none); what is wrong with others goes to complaints. */
  std::string newest()
  {
    complaints.clear();
    const auto found = checkpoints->newest_good(complaints);
    return found ? found->metadata.at("time") : "none";
  }

  std::unique_ptr<CheckpointDirectory> checkpoints;
  std::vector<std::string> complaints;
};

TEST_F(CheckpointTest, TheLastAreKeptAndTheNewestIsFound)
{
  EXPECT_EQ(newest(), "none");
  EXPECT_TRUE(complaints.empty());
  for (const char *time : {"0.1", "0.2", "0.3"})
    write(time);
  EXPECT_EQ(checkpoints->numbers(), (std::vector<unsigned int>{2, 3}));
  EXPECT_EQ(newest(), "0.3");
  EXPECT_TRUE(complaints.empty());
  const auto found = checkpoints->newest_good(complaints);
  EXPECT_EQ(found->number, 3u);
  EXPECT_EQ(found->path, path("checkpoint/00003"));
  EXPECT_EQ(found->metadata.at("command_line"), "gemmule a = b");
  write("0.4", 1);
  EXPECT_EQ(checkpoints->numbers(), (std::vector<unsigned int>{4}));
  // Another object, as after a restart, goes on after it.
  checkpoints = std::make_unique<CheckpointDirectory>(directory);
  write("0.5");
  EXPECT_EQ(checkpoints->numbers(), (std::vector<unsigned int>{4, 5}));
}

TEST_F(CheckpointTest, EveryDamageIsNoticed)
{
  write("0.1");
  write("0.2");
  const std::string state = content("checkpoint/00002/state.h5");
  const std::string metadata = content("checkpoint/00002/metadata.txt");
  const auto expect_fallback = [&](const std::string &complaint)
  {
    EXPECT_EQ(newest(), "0.1") << complaint;
    ASSERT_EQ(complaints.size(), 1u) << complaint;
    EXPECT_NE(complaints[0].find("checkpoint/00002 cannot be used: "), std::string::npos) << complaints[0];
    EXPECT_NE(complaints[0].find(complaint), std::string::npos) << complaints[0];
    overwrite("checkpoint/00002/state.h5", state);
    overwrite("checkpoint/00002/metadata.txt", metadata);
    EXPECT_EQ(newest(), "0.2") << "mended";
  };

  std::string flipped = state;
  flipped[500] ^= 1;
  overwrite("checkpoint/00002/state.h5", flipped);
  expect_fallback("state.h5 is damaged");
  overwrite("checkpoint/00002/state.h5", state.substr(0, 900));
  expect_fallback("state.h5 is damaged");
  overwrite("checkpoint/00002/state.h5", state + "x");
  expect_fallback("state.h5 is damaged");
  std::filesystem::remove(path("checkpoint/00002/state.h5"));
  expect_fallback("state.h5 is missing");
  std::filesystem::remove(path("checkpoint/00002/metadata.txt"));
  expect_fallback("incomplete");
  // Every truncation and every changed byte of the metadata.
  for (std::size_t n = 0; n < metadata.size(); ++n)
  {
    overwrite("checkpoint/00002/metadata.txt", metadata.substr(0, n));
    ASSERT_EQ(newest(), "0.1") << "truncated after " << n << " bytes";
    std::string changed = metadata;
    changed[n] ^= 1;
    overwrite("checkpoint/00002/metadata.txt", changed);
    ASSERT_EQ(newest(), "0.1") << "byte " << n << " changed";
  }
}

TEST_F(CheckpointTest, WhatIsIncompleteOrDamagedMakesRoomForTheNext)
{
  write("0.1");
  write("0.2");
  std::ofstream(checkpoints->begin() + "/state.h5") << "half"; // and then it was killed
  EXPECT_EQ(newest(), "0.2");
  EXPECT_EQ(complaints.size(), 1u);
  overwrite("checkpoint/00002/state.h5", "damaged");
  EXPECT_EQ(newest(), "0.1");
  EXPECT_EQ(complaints.size(), 2u);

  checkpoints = std::make_unique<CheckpointDirectory>(directory);
  std::ofstream(checkpoints->begin() + "/state.h5") << "new";
  checkpoints->complete({{"time", "0.3"}}, 2, {2, 3});
  EXPECT_EQ(checkpoints->numbers(), (std::vector<unsigned int>{1, 4})) << "the good ones";
  EXPECT_EQ(newest(), "0.3");
}

TEST_F(CheckpointTest, OtherFilesAreLeftAlone)
{
  std::filesystem::create_directories(path("checkpoint/00001-mine"));
  std::filesystem::create_directories(path("checkpoint/7"));
  std::ofstream(path("checkpoint/00009")) << "a file";
  write("0.1", 1);
  write("0.2", 1);
  for (const char *name : {"checkpoint/00001-mine", "checkpoint/7", "checkpoint/00009"})
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
  EXPECT_EQ(checkpoints->numbers(), (std::vector<unsigned int>{2}));
}

TEST_F(CheckpointTest, FilesThatOthersPutIntoACheckpointStay)
{
  write("0.1", 1);
  std::ofstream(path("checkpoint/00001/notes.txt")) << "interesting";
  write("0.2", 1);
  EXPECT_EQ(content("checkpoint/00001/notes.txt"), "interesting");
  EXPECT_FALSE(std::filesystem::exists(path("checkpoint/00001/state.h5")));
  EXPECT_EQ(newest(), "0.2");
  checkpoints->remove_all();
  EXPECT_EQ(newest(), "none");
  EXPECT_EQ(content("checkpoint/00001/notes.txt"), "interesting");
  EXPECT_FALSE(std::filesystem::exists(path("checkpoint/00002")));
}

TEST_F(CheckpointTest, AFullDiskLeavesTheEarlierOnes)
{
  write("0.1");
  const std::string place = checkpoints->begin();
  std::ofstream(place + "/state.h5") << "state";
  {
    const FullDisk full_disk(20);
    const std::string message = message_of([&] { checkpoints->complete({{"time", "0.2"}}, 1); });
    EXPECT_EQ(message, "Cannot write " + place +
                           "/metadata.txt: the file would be larger than files may be here. Raise the limit "
                           "('ulimit -f', or that of the file system).");
  }
  EXPECT_EQ(newest(), "0.1");
  checkpoints->abandon();
  EXPECT_EQ(checkpoints->numbers(), (std::vector<unsigned int>{1}));
  write("0.3");
  EXPECT_EQ(newest(), "0.3");
}

TEST(Checksums, AreThoseOfOtherPrograms)
{
  // The check value of CRC-32 in its definitions.
  EXPECT_EQ(Checksum::of_text("123456789").crc, 0xcbf43926u);
  EXPECT_EQ(Checksum::of_text("123456789").size, 9u);
  EXPECT_EQ(Checksum::of_text("").crc, 0u);
}

/** A bit of everything that a state may consist of. */
struct Example
{
  struct Part
  {
    dealii::Point<2> point;
    std::array<dealii::Tensor<1, 2>, 3> vectors;
  };
  double number = 0.;
  bool truth = false;
  unsigned int count = 0;
  std::vector<double> list;
  std::vector<Part> parts;
  std::vector<std::array<unsigned int, 2>> pairs;
};

void exchange(ArrayExchange &archive, Example &example)
{
  archive.scope("outer",
                [&]
                {
                  archive("number", example.number);
                  archive.scope("inner", [&] { archive("truth", example.truth); });
                });
  archive("count", example.count);
  archive("list", example.list);
  archive.member(
      "point", example.parts, [](auto &part) -> auto & { return part.point; });
  archive.member(
      "vectors", example.parts, [](auto &part) -> auto & { return part.vectors; });
  archive.integers("pairs", example.pairs);
}

class ParallelNamedArraysTest : public ParallelOutputTest
{
};

TEST_F(ParallelNamedArraysTest, StatesComeBackExactlyOnAllRanks)
{
  Example example;
  example.number = 1. / 3.;
  example.truth = true;
  example.count = 4000000001u;
  example.list = {std::numeric_limits<double>::denorm_min(), -0., std::nextafter(1., 2.)};
  example.parts.resize(2);
  example.parts[1].point = dealii::Point<2>(0.1, 0.2);
  example.parts[1].vectors[2][1] = 0.7;
  example.pairs = {{{1, 2}}, {{3, 4}}, {{5, 4000000002u}}};
  ArrayExchange archive = ArrayExchange::packing();
  exchange(archive, example);

  NamedArrays arrays;
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 archive.result().write(path("state.h5"), Provenance("gemmule", {{"End time", "1"}}));
                 arrays = NamedArrays::read(path("state.h5"));
               });
  arrays.broadcast(MPI_COMM_WORLD);
  Example copy;
  copy.list = {7.};
  ArrayExchange reading = ArrayExchange::unpacking(arrays);
  exchange(reading, copy);
  EXPECT_EQ(copy.number, example.number);
  EXPECT_EQ(copy.truth, true);
  EXPECT_EQ(copy.count, example.count);
  EXPECT_EQ(copy.list, example.list);
  ASSERT_EQ(copy.parts.size(), 2u);
  EXPECT_EQ(copy.parts[1].point, example.parts[1].point);
  EXPECT_EQ(copy.parts[1].vectors[2], example.parts[1].vectors[2]);
  EXPECT_EQ(copy.pairs, example.pairs);

  // An empty state is one as well.
  Example empty;
  ArrayExchange of_empty = ArrayExchange::packing();
  exchange(of_empty, empty);
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 of_empty.result().write(path("empty.h5"), Provenance());
                 ArrayExchange again = ArrayExchange::unpacking(NamedArrays::read(path("empty.h5")));
                 exchange(again, copy);
                 EXPECT_TRUE(copy.parts.empty());
                 EXPECT_TRUE(copy.pairs.empty());
               });

  std::vector<std::array<double, 5>> other_shape;
  EXPECT_THROW(reading("list", other_shape), SimulationError);
  EXPECT_THROW(reading("absent", copy.number), SimulationError);
}

TEST(RunMemory, StatisticsRowsAndStepControlComeBackExactly)
{
  StatisticsRow row;
  row.time = 0.1;
  row.step = 17;
  row.cells = 12345678901ul;
  row.time_error_composition = 1. / 3.;
  const StatisticsRow copy = to_statistics_row(to_numbers(row));
  EXPECT_EQ(to_numbers(copy), to_numbers(row));
  EXPECT_EQ(copy.step, 17u);
  EXPECT_EQ(copy.cells, 12345678901ul);
  EXPECT_EQ(copy.time_error_composition, 1. / 3.);

  // Two controls, of which one is replaced halfway: after a rejection, with a noise floor.
  const auto error = [](const double step) { return 5. + std::pow(step / 0.05, 3); };
  Parameters::TimeStepping parameters;
  parameters.initial_step = 0.01;
  StepControl control(parameters, 0., {0.7, 1.});
  for (unsigned int i = 0; i < 9; ++i)
    control.judge(error(control.propose(0.03)));
  StepControl other(parameters, 0., {0.7, 1.});
  other.restore(control.memory());
  EXPECT_GT(control.time(), 0.);
  EXPECT_GT(control.noise_floor(), 0.);
  while (!control.finished())
  {
    const double step = control.propose(0.03);
    ASSERT_EQ(other.propose(0.03), step);
    ASSERT_EQ(other.judge(error(step)), control.judge(error(step)));
    ASSERT_EQ(other.time(), control.time());
  }
  EXPECT_TRUE(other.finished());
}

TEST(FixedParameters, AreThoseThatTheSolutionDependsOn)
{
  const AllParameters before;
  AllParameters now;
  now.end_time = 7.;
  now.output_directory = "elsewhere";
  now.output.field_interval = 0.25;
  now.output.interface_interval = 0.;
  now.output.output_times = {0.1, 0.2};
  now.output.progress = false;
  now.checkpoint.steps_between = 5;
  now.checkpoint.wall_clock_interval = 1.;
  now.checkpoint.number_kept = 9;
  now.checkpoint.wall_time_limit = 60.;
  EXPECT_TRUE(changed_fixed_parameters(before, now).empty());

  now.fluid.viscosity_ratio = 10.;
  now.membrane.level_set = "x^2+y^2-0.1";
  now.mesh.membrane_level += 1;
  now.time_stepping.tolerance *= 0.5;
  const auto changes = changed_fixed_parameters(before, now);
  ASSERT_EQ(changes.size(), 4u);
  EXPECT_EQ(changes[0], "Fluid/Viscosity ratio: '1' in the checkpoint, '10' now");
}
} // namespace
