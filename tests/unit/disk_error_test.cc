// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages about files that cannot be written: the true reason, and what removes it.
#include <gemmule/output/disk.h>
#include <gemmule/output/hdf5_file.h>

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "support/output_test.h"

using namespace Gemmule;

namespace
{
class DiskErrorTest : public OutputTest
{
protected:
  /** The only file of the directory, or a list of what is there. */
  std::string listing() const
  {
    std::error_code error;
    std::string text;
    for (const std::string &name : names_in(directory, error))
      text += name + " ";
    return text;
  }
};

TEST_F(DiskErrorTest, EachReasonHasItsOwnWords)
{
  EXPECT_STREQ(disk_error("Cannot write x", ENOSPC).what(), "Cannot write x: the disk is full. Make room.");
  EXPECT_STREQ(disk_error("Cannot write x", EROFS).what(),
               "Cannot write x: the file system is read-only. Have it made writable.");
  std::vector<std::string> reasons;
  for (const int error : {0, ENOSPC, EDQUOT, EFBIG, EACCES, EROFS, ENOENT, ENOTDIR, EISDIR, ELOOP,
                          ENAMETOOLONG, EAGAIN, ENOLCK, EMFILE, EIO, ESTALE, EPIPE, ENXIO})
  {
    const SystemReason why = explain(error);
    EXPECT_EQ(std::count(reasons.begin(), reasons.end(), why.reason), 0) << why.reason;
    EXPECT_FALSE(why.remedy.empty()) << why.reason;
    EXPECT_EQ(why.reason.find("full") != std::string::npos, error == ENOSPC) << why.reason;
    reasons.push_back(why.reason);
  }
  EXPECT_NE(explain(ENXIO).reason.find("No such device or address"), std::string::npos)
      << explain(ENXIO).reason;
}

TEST_F(DiskErrorTest, WhatALibraryDoesNotSayIsLookedFor)
{
  std::ofstream(path("file")) << "text";
  EXPECT_EQ(likely_error_of_writing(path("file")), 0);
  EXPECT_EQ(likely_error_of_writing(path("new")), 0);
  EXPECT_EQ(likely_error_of_writing(path("missing/file")), ENOENT);
  EXPECT_EQ(likely_error_of_writing(path("file/file")), ENOTDIR);
  EXPECT_EQ(likely_error_of_writing(directory), EISDIR);
  EXPECT_EQ(likely_error_of_writing(path("new"), std::size_t(1) << 60), ENOSPC);
  const FullDisk full_disk(1000);
  EXPECT_EQ(likely_error_of_writing(path("new"), 100), 0);
  EXPECT_EQ(likely_error_of_writing(path("new"), 2000), EFBIG);
}

TEST_F(DiskErrorTest, AFileOfHdf5ThatIsMissingIsNotCalledFull)
{
  for (const auto mode : {Hdf5File::Mode::read, Hdf5File::Mode::modify})
    EXPECT_EQ(message_of([&] { Hdf5File(path("absent.h5"), mode); }),
              "Cannot open " + path("absent.h5") +
                  ": the file or its directory does not exist. Put it back if it has been moved.");
  EXPECT_EQ(listing(), "") << "nothing comes into being";
  EXPECT_EQ(message_of([&] { Hdf5File(path("absent/new.h5"), Hdf5File::Mode::create); }),
            "Cannot write " + path("absent/new.h5") +
                ": the file or its directory does not exist. Put it back if it has been moved.");
}

TEST_F(DiskErrorTest, AFileOfHdf5ThatIsDamagedIsCalledThatAndStaysAsItIs)
{
  std::ofstream(path("text.h5")) << "This is no HDF5 file.";
  EXPECT_EQ(message_of([&] { Hdf5File(path("text.h5"), Hdf5File::Mode::modify, 1000); }),
            "Cannot open " + path("text.h5") + ": the file is damaged, or no HDF5 file. Move it away.");
  EXPECT_EQ(content("text.h5"), "This is no HDF5 file.");

  Hdf5File(path("cut.h5"), Hdf5File::Mode::create, 1000).close();
  std::filesystem::resize_file(path("cut.h5"), 60);
  const std::string before = content("cut.h5");
  EXPECT_NE(message_of([&] { Hdf5File(path("cut.h5"), Hdf5File::Mode::modify, 1000); }).find("is damaged"),
            std::string::npos);
  EXPECT_EQ(content("cut.h5"), before);
}

TEST_F(DiskErrorTest, AReaderThatLocksAFileOfHdf5StopsNobody)
{
  Hdf5File(path("file.h5"), Hdf5File::Mode::create, 1000).close();
  const int other = open(path("file.h5").c_str(), O_RDONLY);
  ASSERT_EQ(flock(other, LOCK_SH), 0);
  EXPECT_NO_THROW(Hdf5File(path("file.h5"), Hdf5File::Mode::modify));
  close(other);
}

TEST_F(DiskErrorTest, HalfAFileDoesNotStay)
{
  replace_file(path("old"), "old");
  {
    const FullDisk full_disk(1000);
    EXPECT_THROW(Hdf5File(path("new.h5"), Hdf5File::Mode::create, 5000), DiskError);
    EXPECT_THROW(replace_file(path("old"), std::string(2000, 'x')), DiskError);
    EXPECT_THROW(reserve_space(path("new"), 2000), DiskError);
  }
  {
    std::ofstream(path("source")) << std::string(2000, 'x');
    const FullDisk full_disk(1000);
    EXPECT_THROW(copy_file(path("source"), path("old")), DiskError);
    EXPECT_THROW(copy_file(path("absent"), path("old")), DiskError);
    std::filesystem::remove(path("source"));
  }
  EXPECT_EQ(listing(), "old ");
  EXPECT_EQ(content("old"), "old");
  {
    // Nor one that nobody has brought to its end.
    Hdf5File file(path("new.h5"), Hdf5File::Mode::create, 5000);
    EXPECT_EQ(listing(), "new.h5.part old ");
  }
  EXPECT_EQ(listing(), "old ");
}

TEST_F(DiskErrorTest, AFileIsWrittenInPlaceOfALinkAndNotThroughIt)
{
  std::ofstream(path("elsewhere")) << "precious";
  std::filesystem::create_symlink("elsewhere", path("file"));
  std::filesystem::create_symlink("elsewhere", path("file.part"));
  replace_file(path("file"), "new");
  EXPECT_EQ(content("elsewhere"), "precious");
  EXPECT_EQ(content("file"), "new");
}
} // namespace
