// SPDX-License-Identifier: LGPL-2.1-or-later
// Disks of many sizes that become full, and others that do not take the results: the message says why, and
// what it advises leads to the results of a run that nothing has disturbed.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mount.h>

#include "survival_fixture.h"

using namespace Gemmule::Testing;

class FullDisk : public Survival
{
protected:
  static constexpr const char *brief = "--set 'End time=0.002' --set 'Output/Field output interval=0.001' ";

  static void SetUpTestSuite()
  {
    Survival::SetUpTestSuite();
    brief_directory = std::make_unique<TemporaryDirectory>();
    brief_directory->write("case.prm", small_case);
    ASSERT_EQ(run_gemmule(*brief_directory, std::string("case.prm --output reference ") + brief).exit_code,
              0);
  }
  static void TearDownTestSuite() { brief_directory.reset(); }
  static std::string brief_reference() { return brief_directory->file("reference"); }

  /** A small file system at the place of the results' parent; unmounted at the end. */
  class SmallDisk
  {
  public:
    explicit SmallDisk(const std::string &path) : path(path) { std::filesystem::create_directory(path); }
    ~SmallDisk() { umount2(path.c_str(), MNT_DETACH); }
    bool mount(const std::string &options, const unsigned long flags = 0) const
    {
      return ::mount("tmpfs", path.c_str(), "tmpfs", flags, options.c_str()) == 0;
    }

  private:
    const std::string path;
  };

  /** Every file is one that a reader can use. */
  static void expect_whole_files(const std::string &path)
  {
    for (const auto &entry : std::filesystem::recursive_directory_iterator(path))
      if (entry.path().extension() == ".h5")
        EXPECT_NO_THROW(Gemmule::Hdf5File(entry.path(), Gemmule::Hdf5File::Mode::read)) << entry.path();
      else
        EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }

private:
  static inline std::unique_ptr<TemporaryDirectory> brief_directory;
};

TEST_F(FullDisk, OfAnySizeTheAdviceOfTheMessageWorks)
{
  unsigned int n_before_first_checkpoint = 0, n_later = 0;
  for (const unsigned int kilobytes : {4, 20, 40, 200, 350, 500, 900, 1100, 1300})
  {
    const SmallDisk disk(directory.file("disk"));
    if (!disk.mount("size=" + std::to_string(kilobytes) + "k"))
      GTEST_SKIP() << "mounting a small file system needs permissions that this user does not have";
    const std::string output = "disk/run",
                      options = std::string(brief) + (kilobytes > 1000 ? "--set 'Checkpoint/Steps between "
                                                                         "checkpoints=1' "
                                                                       : "");
    const Result full = run_gemmule(directory, run(options, output));
    ASSERT_EQ(full.exit_code, 2) << kilobytes << full.out << full.err;
    EXPECT_NE(full.err.find("the disk is full. Make room. Then "), std::string::npos) << full.err;
    expect_whole_files(directory.file(output));
    const bool has_checkpoint = full.err.find("Then go on with --resume.") != std::string::npos;
    EXPECT_NE(has_checkpoint, full.err.find("Then repeat the command.") != std::string::npos) << full.err;
    (has_checkpoint ? n_later : n_before_first_checkpoint) += 1;

    ASSERT_TRUE(disk.mount("size=100m", MS_REMOUNT));
    // Who takes the one for the other loses nothing either.
    const bool resumes = has_checkpoint || kilobytes == 350;
    const Result again = run_gemmule(directory, run(options + (resumes ? "--resume" : ""), output));
    EXPECT_EQ(again.exit_code, 0) << kilobytes << again.err;
    Comparison().results(brief_reference(), directory.file(output));
    EXPECT_FALSE(std::filesystem::exists(directory.file(output) + "/earlier-run")) << kilobytes;
  }
  EXPECT_GE(n_before_first_checkpoint, 2u);
  EXPECT_GE(n_later, 2u);
}

TEST_F(FullDisk, ADirectoryThatVanishesEndsTheRunWithTheTrueReason)
{
  RunningProgram program(directory, run());
  ASSERT_TRUE(program.wait_for([&] { return n_rows(results()) >= 3; }));
  std::filesystem::rename(results(), directory.file("moved"));
  EXPECT_EQ(program.wait(), 2);
  const std::string message = directory.read(".stderr");
  EXPECT_NE(message.find("the file or its directory does not exist"), std::string::npos) << message;
  EXPECT_NE(
      message.find("The output directory has been moved or removed while the run was at work: put it back "
                   "and go on with --resume, or repeat the command.\n"),
      std::string::npos)
      << message;
  EXPECT_FALSE(std::filesystem::exists(results()));
  std::filesystem::rename(directory.file("moved"), results());
  resume_to_the_end();
  Comparison().results(reference(), results());
}

TEST_F(FullDisk, ACheckpointThatAnotherProgramLocksIsCalledThat)
{
  ASSERT_EQ(run_gemmule(directory, run("--set 'Checkpoint/Wall time limit=1e-6'")).exit_code, 3);
  const int other = open((complete_checkpoints().back() + "/state.h5").c_str(), O_RDWR);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  const Result locked = run_gemmule(directory, run("--resume"), 1, "env HDF5_USE_FILE_LOCKING=TRUE ");
  close(other);
  EXPECT_EQ(locked.exit_code, 2) << locked.out;
  EXPECT_NE(locked.err.find("state.h5: another program has locked it. Close it there, or set the environment "
                            "variable HDF5_USE_FILE_LOCKING to FALSE. Then go on with --resume.\n"),
            std::string::npos)
      << locked.err;
}
