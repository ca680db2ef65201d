// SPDX-License-Identifier: LGPL-2.1-or-later
// What is in the output directory before a run: whose it is, and what becomes of it.
#include <gemmule/base/exceptions.h>
#include <gemmule/output/checkpoint_directory.h>
#include <gemmule/output/earlier_results.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/provenance.h>
#include <gemmule/output/statistics.h>

#include "support/output_test.h"

using namespace Gemmule;

namespace
{
class EarlierResultsTest : public OutputTest
{
protected:
  void write(const std::string &name, const std::string &text) const
  {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }

  void write_hdf5(const std::string &name, const Provenance &provenance) const
  {
    Hdf5File file(path(name), Hdf5File::Mode::create, provenance.n_bytes());
    provenance.write(file);
    file.create_group("step_00000");
    file.close();
  }

  /** What a run to t = 0.2 leaves, whose checkpoint of t = 0.1 or 0.2 is the last. */
  void write_run(const std::string &last_checkpoint = "0.2", const std::string &finished = "yes") const
  {
    write("log.txt", "Gemmule 0.1.0\nresults in run\n");
    write("parameters.prm", "# Listing of Parameters\n# ---------------------\nset End time = 0.2\n");
    {
      StatisticsWriter writer(directory, MPI_COMM_SELF);
      StatisticsRow row;
      for (const double time : {0., 0.1, 0.2})
      {
        row.time = time;
        writer.write(row);
      }
    }
    write_hdf5("interface.h5", Provenance("gemmule", {}));
    write_hdf5("solution-00000.h5", Provenance("gemmule", {}));
    write("solution.xdmf", "<Xdmf>\n<Grid Name=\"fields\" GridType=\"Collection\">\n");
    write("interface.xdmf", "<Xdmf>\n<Grid Name=\"membrane\" GridType=\"Collection\">\n");
    CheckpointDirectory checkpoints(directory);
    std::ofstream(checkpoints.begin() + "/state.h5") << "state";
    checkpoints.complete({{"time", last_checkpoint}, {"finished", finished}}, 2);
  }

  /** Begins a run. @return where results have been moved to, "" if nowhere, or the message of a refusal */
  std::string begin() const
  {
    try
    {
      return OutputDirectory(directory, MPI_COMM_SELF).earlier_run();
    }
    catch (const UserError &error)
    {
      return error.what();
    }
  }

  bool has(const std::string &name) const { return std::filesystem::exists(path(name)); }
};

const std::vector<std::string> results = {"statistics.csv", "interface.h5",      "interface.xdmf",
                                          "solution.xdmf",  "solution-00000.h5", "checkpoint/00001"};

TEST_F(EarlierResultsTest, OfAFinishedRunAreReplacedAndWhatIsBesideThemStays)
{
  write_run();
  const std::vector<std::string> others = {"notes.txt",          "solution-best.h5",      "snapshots.png",
                                           "checkpoint-of-mine", "old/statistics.csv",    "solution-123.h5",
                                           "checkpoint/notes",   "checkpoint/00001/notes"};
  for (const std::string &name : others)
    write(name, "content");
  EXPECT_EQ(begin(), "");
  for (const std::string &name : results)
    EXPECT_FALSE(has(name) && name != "checkpoint/00001") << name;
  EXPECT_FALSE(has("checkpoint/00001/state.h5"));
  for (const std::string &name : others)
    EXPECT_EQ(content(name), "content") << name;
}

TEST_F(EarlierResultsTest, OfOtherRunsAreMoved)
{
  const std::vector<std::function<void()>> lives = {
      [&] { write_run("0.1", "no"); },  // not finished
      [&] { write_run("0.1", "yes"); }, // finished at t = 0.1, then extended
      [&] {                             // no checkpoint at all
        write_run();
        std::filesystem::remove_all(path("checkpoint"));
      },
      [&] { // none that is whole
        write_run();
        write("checkpoint/00001/metadata.txt", "");
      },
      [&] { // results that are damaged
        write_run();
        write("solution-00000.h5", content("solution-00000.h5").substr(0, 700));
      },
      [&] { // killed while it wrote
        write_run("0.1", "no");
        Hdf5File(path("file.h5"), Hdf5File::Mode::create).close();
        std::filesystem::rename(path("file.h5"), path("solution-00001.h5.part"));
      },
      [&] { // killed early
        write_run();
        std::filesystem::remove_all(path("checkpoint"));
        for (const char *name : {"statistics.csv", "log.txt", "interface.h5"})
          write(name, "");
      }};
  for (std::size_t i = 0; i < lives.size(); ++i)
  {
    lives[i]();
    const std::string fields = content("solution-00000.h5");
    const std::string folder = path("earlier-run") + (i == 0 ? "" : "-" + std::to_string(i + 1));
    EXPECT_EQ(begin(), folder) << "life " << i;
    for (const std::string &name : results)
      EXPECT_FALSE(has(name)) << name << " of life " << i;
    EXPECT_EQ(content(folder.substr(directory.size() + 1) + "/solution-00000.h5"), fields) << "life " << i;
    EXPECT_TRUE(std::filesystem::exists(folder + "/parameters.prm")) << "life " << i;
  }
}

TEST_F(EarlierResultsTest, WithoutAStepAreNotKept)
{
  write_run();
  std::filesystem::remove_all(path("checkpoint"));
  std::filesystem::remove(path("solution-00000.h5"));
  StatisticsWriter(directory, MPI_COMM_SELF); // no rows
  Hdf5File(path("interface.h5"), Hdf5File::Mode::create).close();
  const Provenance provenance("gemmule", {});
  {
    Hdf5File file(path("interface.h5"), Hdf5File::Mode::modify, provenance.n_bytes());
    provenance.write(file);
    file.close();
  }
  EXPECT_EQ(begin(), "");
  EXPECT_FALSE(has("earlier-run"));
}

TEST_F(EarlierResultsTest, ThatAreForeignAreRefusedAndNothingChanges)
{
  for (const char *name : {"statistics.csv", "log.txt", "parameters.prm", "interface.h5", "interface.xdmf",
                           "solution.xdmf", "solution-00007.h5", "solution-123456.h5", "checkpoint/model.pt",
                           "checkpoint", "statistics.csv.part", "solution-00000.h5.part", ".lock"})
  {
    write(name, "1,2,3");
    EXPECT_NE(begin().find(std::filesystem::path(name).begin()->string() +
                           "', which no run of gemmule has written there and a run would replace. Move it "
                           "elsewhere, or choose another directory with --output"),
              std::string::npos)
        << begin();
    EXPECT_EQ(content(name), "1,2,3");
    EXPECT_FALSE(has(".lock") && std::string(name) != ".lock") << "the directory is not ours by that";
    std::filesystem::remove_all(directory);
    std::filesystem::create_directories(directory);
  }
  // Where one name is ours by its content, but no run was here.
  write_hdf5("solution-00007.h5", Provenance("gemmule", {}));
  EXPECT_NE(begin().find("'solution-00007.h5', which no run"), std::string::npos) << begin();
  std::filesystem::remove(path("solution-00007.h5"));
  // An HDF5 file of another program.
  Hdf5File(path("solution-00007.h5"), Hdf5File::Mode::create).close();
  EXPECT_NE(begin().find("'solution-00007.h5', which no run"), std::string::npos) << begin();
  // Links, to something and to nothing, and folders.
  write("elsewhere", "1,2,3");
  std::filesystem::create_symlink("elsewhere", path("statistics.csv"));
  std::filesystem::create_symlink("nowhere", path("log.txt"));
  std::filesystem::create_directory(path("interface.xdmf"));
  EXPECT_NE(begin().find("'interface.xdmf', 'log.txt', 'solution-00007.h5' and 'statistics.csv', which"),
            std::string::npos)
      << begin();
  EXPECT_EQ(content("elsewhere"), "1,2,3");
  EXPECT_FALSE(has("nowhere"));
}

TEST_F(EarlierResultsTest, ThatAreForeignAreRefusedInTheDirectoryOfARunAsWell)
{
  for (const char *const finished : {"yes", "no"})
  {
    write_run("0.2", finished);
    Hdf5File(path("solution-00099.h5"), Hdf5File::Mode::create).close();
    EXPECT_NE(begin().find("'solution-00099.h5', which no run"), std::string::npos) << begin();
    for (const std::string &name : results)
      EXPECT_TRUE(has(name)) << name;
    std::filesystem::remove_all(directory);
    std::filesystem::create_directories(directory);
  }
}

TEST_F(EarlierResultsTest, ThatAreEmptyAreInNobodysWay)
{
  write("statistics.csv", "");
  write("log.txt", "");
  std::filesystem::create_directory(path("checkpoint"));
  EXPECT_EQ(begin(), "");
  EXPECT_TRUE(has(".lock"));
}

TEST_F(EarlierResultsTest, AreRecognisedByTheirLockAlone)
{
  write(".lock", "process 123 on host");
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  writer.write(StatisticsRow());
  EXPECT_EQ(begin(), path("earlier-run"));
  EXPECT_FALSE(has("statistics.csv"));
  EXPECT_TRUE(has("earlier-run/statistics.csv"));
}

TEST_F(EarlierResultsTest, OfALinkKeepWhatTheLinkPointsTo)
{
  write_run("0.1", "no");
  std::filesystem::create_directory(path("large-disk"));
  std::filesystem::rename(path("interface.h5"), path("large-disk/interface.h5"));
  std::filesystem::create_symlink("large-disk/interface.h5", path("interface.h5"));
  EXPECT_EQ(begin(), path("earlier-run"));
  EXPECT_TRUE(has("earlier-run/interface.h5")) << "the link is to be followed from there";
  EXPECT_FALSE(has("interface.h5"));
}

TEST_F(EarlierResultsTest, MakeRoomForAResumedRunOnlyWhereTheyAreNotItsOwn)
{
  write_run("0.1", "no");
  write("interface.h5", "garbage");
  write("solution-00001.h5", "garbage that is listed");
  write("solution-00002.h5", "other");
  write_hdf5("solution-00003.h5", Provenance("gemmule", {}));
  write("solution-00002.h5.part", std::string(1000, '\0')); // what a kill leaves
  const OutputDirectory resumed(directory, MPI_COMM_SELF, /*resume =*/true);
  const std::string warning = resumed.move_foreign_files(2);
  EXPECT_EQ(warning, "what 'interface.h5' and 'solution-00002.h5' held is not known as written by a run of "
                     "gemmule; it is in " +
                         path("earlier-run") + " now.");
  EXPECT_EQ(content("earlier-run/interface.h5"), "garbage");
  EXPECT_EQ(content("earlier-run/solution-00002.h5"), "other");
  EXPECT_EQ(content("solution-00001.h5"), "garbage that is listed");
  EXPECT_TRUE(has("solution-00003.h5")) << "a run's own, which is cut off elsewhere";
  EXPECT_TRUE(has("solution-00002.h5.part")) << "is written anew";
  EXPECT_EQ(resumed.move_foreign_files(2), "");
}

TEST_F(EarlierResultsTest, OfARunThatEndedBeforeItsFirstCheckpointAreNothingToResume)
{
  EXPECT_FALSE(OutputDirectory::has_only_begun(directory));
  write_run();
  EXPECT_FALSE(OutputDirectory::has_only_begun(directory)) << "it has a checkpoint";
  std::filesystem::remove(path("checkpoint/00001/metadata.txt"));
  EXPECT_FALSE(OutputDirectory::has_only_begun(directory)) << "it has made steps";
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  writer.write(StatisticsRow());
  EXPECT_TRUE(OutputDirectory::has_only_begun(directory));
}

TEST_F(EarlierResultsTest, FilesOfOthersAreNotUsedForChecksAndLocks)
{
  write(".write-test", "mine");
  write(".lock", "mine");
  {
    const OutputDirectory resumed(directory, MPI_COMM_SELF, /*resume =*/true);
    EXPECT_THROW(OutputDirectory(directory, MPI_COMM_SELF, true), UserError) << "locked nevertheless";
  }
  EXPECT_EQ(content(".write-test"), "mine");
  EXPECT_EQ(content(".lock"), "mine");
}
} // namespace
