#include <gemmule/output/disk.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/parameters/errors.h>

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

template <typename Result>
Result Hdf5File::check(const Result result, const std::string &doing) const
{
  if (result >= 0)
    return result;
  if (for_reading)
    throw SimulationError("Cannot " + doing + " " + path +
                          ": the file is missing or damaged. Restore it, or move it away and start anew.");
  throw SimulationError("Cannot " + doing + " " + path +
                        ": is the disk full, or the file damaged or write-protected? Make room and go on "
                        "with --resume.");
}

Hdf5File::Hdf5File(const std::string &path, const Mode mode, const std::size_t growth)
    : path(path), for_reading(mode == Mode::read)
{
  if (!for_reading)
    reserve_space(path, growth + size_of_bookkeeping);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // Handles that an exception leaves open must not keep the file open.
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  // Someone who looks at the results must not stop the run that writes them.
  H5Pset_file_locking(access, /*use_file_locking =*/false, /*ignore_when_disabled =*/true);
  if (mode == Mode::create)
    file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  else
    file = H5Fopen(path.c_str(), mode == Mode::modify ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  check(file, "open");
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
  const herr_t flushed = H5Fflush(closing, H5F_SCOPE_LOCAL);
  const herr_t closed = H5Fclose(closing);
  check(std::min(flushed, closed), "finish");
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
