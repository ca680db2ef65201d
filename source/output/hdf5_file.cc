// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/hdf5_file.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>

namespace Gemmule
{
namespace
{
  /** Bytes that HDF5 may add for itself in one session: headers of some twenty objects, the root's index. */
  constexpr std::size_t size_of_bookkeeping = 131072;

  /** Closes a handle at the end of its scope. */
  class Handle
  {
  public:
    Handle(const hid_t id, herr_t (*close)(hid_t)) : id(id), close(close) {}
    ~Handle() { close(id); }
    Handle(const Handle &) = delete;
    Handle &operator=(const Handle &) = delete;
    operator hid_t() const { return id; }

  private:
    const hid_t id;
    herr_t (*const close)(hid_t);
  };
} // namespace

Hdf5Silence::Hdf5Silence()
{
  H5Eget_auto2(H5E_DEFAULT, &messages, &messages_data);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Silence::~Hdf5Silence()
{
  H5Eset_auto2(H5E_DEFAULT, messages, messages_data);
}

bool begins_as_hdf5(const std::string &path)
{
  // H5Fis_hdf5() would lock it.
  const std::string signature = "\x89HDF\r\n\x1a\n";
  std::string start(signature.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == signature;
}

int system_error_of_hdf5()
{
  const auto find = [](unsigned int, const H5E_error2_t *const error, void *const result) -> herr_t
  {
    // As in "unable to open file: name = 'x.h5', errno = 2, error message = 'No such file or directory'".
    const std::string text = error->desc != nullptr ? error->desc : "", mark = "errno = ";
    const auto place = text.find(mark);
    int &number = *static_cast<int *>(result);
    if (place != std::string::npos && number == 0)
      number = std::atoi(text.c_str() + place + mark.size());
    return 0;
  };
  int number = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find, &number);
  return number;
}

void Hdf5File::fail(const std::string &doing, const int system_error) const
{
  const std::string what = "Cannot " + doing + " " + complete_name(path);
  if (system_error != 0)
    throw disk_error(what, system_error);
  throw DiskError(what + ": the file is damaged, or no HDF5 file. " +
                  (for_reading ? "Restore it from a copy." : "Move it away."));
}

template <typename Result>
Result Hdf5File::check(const Result result, const std::string &doing) const
{
  if (result >= 0)
    return result;
  const int error = system_error_of_hdf5();
  fail(doing,
       error != 0 || for_reading ? error : likely_error_of_writing(unfinished ? unfinished->path() : path));
}

Hdf5File::Hdf5File(const std::string &path, const Mode mode, const std::size_t growth)
    : path(path), for_reading(mode == Mode::read)
{
  if (mode == Mode::create)
    unfinished = std::make_unique<UnfinishedFile>(path);
  const std::string &place = unfinished ? unfinished->path() : path;
  std::error_code error;
  // A file that is missing must not come into being, nor one that is no HDF5 file grow.
  const auto size_before = mode == Mode::create ? 0 : std::filesystem::file_size(path, error);
  if (error)
    fail("open", error.value());
  if (mode == Mode::modify && !begins_as_hdf5(path))
    fail("open", likely_error_of_writing(path));
  if (!for_reading)
    reserve_space(place, growth + size_of_bookkeeping);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // Handles that an exception leaves open must not keep the file open.
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  // Someone who looks at the results must not stop the run that writes them.
  H5Pset_file_locking(access, /*use_file_locking =*/false, /*ignore_when_disabled =*/true);
  if (mode == Mode::create)
    file = H5Fcreate(place.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  else
    file = H5Fopen(place.c_str(), for_reading ? H5F_ACC_RDONLY : H5F_ACC_RDWR, access);
  if (file >= 0)
    return;
  const int reason = system_error_of_hdf5();
  if (mode == Mode::modify)
    std::filesystem::resize_file(path, size_before, error);
  fail("open", reason);
}

Hdf5File::~Hdf5File()
{
  if (file >= 0)
    H5Fclose(file);
}

void Hdf5File::close()
{
  const hid_t closing = file;
  file = H5I_INVALID_HID;
  // What is small stays in the library's buffers until now: a full disk may show here only.
  const bool is_flushed = H5Fflush(closing, H5F_SCOPE_LOCAL) >= 0;
  int error = is_flushed ? 0 : system_error_of_hdf5();
  const bool is_closed = H5Fclose(closing) >= 0;
  if (error == 0 && !is_closed)
    error = system_error_of_hdf5();
  if (!is_flushed || !is_closed)
    fail("finish", error != 0 ? error : likely_error_of_writing(unfinished ? unfinished->path() : path));
  if (unfinished)
    unfinished->complete();
}

std::vector<std::string> Hdf5File::members() const
{
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char *name, const H5L_info_t *, void *list) -> herr_t
  {
    static_cast<std::vector<std::string> *>(list)->emplace_back(name);
    return 0;
  };
  check(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names), "list the groups of");
  return names;
}

void Hdf5File::create_group(const std::string &name)
{
  const Handle group(
      check(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "add a group to"),
      H5Gclose);
}

void Hdf5File::remove(const std::string &name)
{
  check(H5Ldelete(file, name.c_str(), H5P_DEFAULT), "remove " + name + " from");
}

void Hdf5File::write_attribute(const std::string &owner, const std::string &name, const hid_t type,
                               const void *value)
{
  const std::string doing = "add the attribute " + name + " to";
  const Handle object(check(H5Oopen(file, owner.c_str(), H5P_DEFAULT), doing), H5Oclose);
  const Handle space(check(H5Screate(H5S_SCALAR), doing), H5Sclose);
  const Handle attribute(
      check(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), doing), H5Aclose);
  check(H5Awrite(attribute, type, value), doing);
}

void Hdf5File::set_attribute(const std::string &owner, const std::string &name, const double value)
{
  write_attribute(owner, name, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5File::set_attribute(const std::string &owner, const std::string &name, const int value)
{
  write_attribute(owner, name, H5T_NATIVE_INT, &value);
}

void Hdf5File::set_attribute(const std::string &owner, const std::string &name, const std::string &value)
{
  // Of variable length, which Python's readers return as a plain string.
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const char *const text = value.c_str();
  write_attribute(owner, name, type, &text);
}

bool Hdf5File::has_attribute(const std::string &owner, const std::string &name) const
{
  return H5Aexists_by_name(file, owner.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

double Hdf5File::number_attribute(const std::string &owner, const std::string &name) const
{
  const std::string doing = "read the attribute " + name + " of " + owner + " from";
  const Handle attribute(
      check(H5Aopen_by_name(file, owner.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), doing), H5Aclose);
  double value = 0.;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), doing);
  return value;
}

std::string Hdf5File::text_attribute(const std::string &owner, const std::string &name) const
{
  const std::string doing = "read the attribute " + name + " of " + owner + " from";
  const Handle attribute(
      check(H5Aopen_by_name(file, owner.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), doing), H5Aclose);
  const Handle type(check(H5Aget_type(attribute), doing), H5Tclose);
  char *text = nullptr;
  check(H5Aread(attribute, type, &text), doing);
  const std::string value(text);
  H5free_memory(text);
  return value;
}

void Hdf5File::write_dataset(const std::string &dataset, const void *values, const std::size_t size,
                             const std::size_t columns, const hid_t type)
{
  const std::string doing = "add " + dataset + " to";
  const hsize_t extents[2] = {columns == 0 ? size : size / columns, columns};
  const Handle space(check(H5Screate_simple(columns == 0 ? 1 : 2, extents, nullptr), doing), H5Sclose);
  const Handle set(
      check(H5Dcreate2(file, dataset.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), doing),
      H5Dclose);
  if (size > 0)
    check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), doing);
}

void Hdf5File::write(const std::string &dataset, const std::vector<double> &values, const std::size_t columns)
{
  write_dataset(dataset, values.data(), values.size(), columns, H5T_NATIVE_DOUBLE);
}

void Hdf5File::write(const std::string &dataset, const std::vector<unsigned int> &values,
                     const std::size_t columns)
{
  write_dataset(dataset, values.data(), values.size(), columns, H5T_NATIVE_UINT);
}

std::vector<std::size_t> Hdf5File::extent(const std::string &dataset) const
{
  const std::string doing = "read " + dataset + " from";
  const Handle set(check(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), doing), H5Dclose);
  const Handle space(check(H5Dget_space(set), doing), H5Sclose);
  std::vector<hsize_t> extents(check(H5Sget_simple_extent_ndims(space), doing));
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  return {extents.begin(), extents.end()};
}

std::vector<double> Hdf5File::read(const std::string &dataset) const
{
  const std::vector<std::size_t> extents = extent(dataset);
  std::vector<double> values(
      std::accumulate(extents.begin(), extents.end(), std::size_t(1), std::multiplies<>()));
  const std::string doing = "read " + dataset + " from";
  const Handle set(check(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), doing), H5Dclose);
  if (!values.empty())
    check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), doing);
  return values;
}
} // namespace Gemmule
