// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <map>
#include <mpi.h>
#include <string>
#include <type_traits>
#include <vector>

namespace Gemmule
{
class Provenance;

/** Arrays of numbers by name: the form in which a state goes to a file and over the ranks. */
class NamedArrays
{
public:
  struct Array
  {
    std::vector<double> values; ///< row by row
    std::size_t columns = 1;
  };

  void set(const std::string &name, Array array) { arrays[name] = std::move(array); }
  /** @throws SimulationError when there is none of this name */
  const Array &get(const std::string &name) const;

  /** Writes all to a new HDF5 file, one dataset each. @throws SimulationError */
  void write(const std::string &path, const Provenance &provenance) const;
  /** Reads what write() wrote. @throws SimulationError */
  static NamedArrays read(const std::string &path);
  /** Makes all ranks have what rank 0 has. Collective. */
  void broadcast(MPI_Comm communicator);

private:
  std::map<std::string, Array> arrays;
};

/**
 * Lists what an object consists of, once for both ways: packing copies its parts into NamedArrays, unpacking
 * takes them out again. A part is a number, a list of numbers, or one member of all elements of a list. Names
 * get the prefixes of the scopes that are open.
 */
class ArrayExchange
{
public:
  static ArrayExchange packing() { return ArrayExchange(true); }
  static ArrayExchange unpacking(const NamedArrays &arrays)
  {
    ArrayExchange exchange(false);
    exchange.arrays = arrays;
    return exchange;
  }

  const NamedArrays &result() const { return arrays; }

  /** Prefixes all names of @p action by "name.". */
  template <typename Action>
  void scope(const std::string &name, const Action &action)
  {
    const std::string outer = prefix;
    prefix += name + ".";
    action();
    prefix = outer;
  }

  template <typename Number>
  std::enable_if_t<std::is_arithmetic<Number>::value> operator()(const std::string &name, Number &number)
  {
    if (is_packing)
      arrays.set(prefix + name, {{static_cast<double>(number)}, 1});
    else
      number = static_cast<Number>(get(name, 1, 1).values[0]);
  }

  /** A list of doubles, or of anything that consists of doubles alone (points, tensors, arrays of them). */
  template <typename Element>
  std::enable_if_t<!std::is_arithmetic<Element>::value || std::is_same<Element, double>::value>
  operator()(const std::string &name, std::vector<Element> &list)
  {
    member(
        name, list, [](auto &element) -> auto & { return element; });
  }

  /** A list of structs of integers. */
  template <typename Element>
  void integers(const std::string &name, std::vector<Element> &list)
  {
    static_assert(std::is_trivially_copyable<Element>::value && sizeof(Element) % sizeof(unsigned int) == 0,
                  "only unsigned integers");
    constexpr std::size_t columns = sizeof(Element) / sizeof(unsigned int);
    if (is_packing)
    {
      const auto *const first = reinterpret_cast<const unsigned int *>(list.data());
      arrays.set(prefix + name, {std::vector<double>(first, first + list.size() * columns), columns});
      return;
    }
    const NamedArrays::Array &array = get(name, columns);
    list.resize(array.values.size() / columns);
    auto *const first = reinterpret_cast<unsigned int *>(list.data());
    for (std::size_t i = 0; i < array.values.size(); ++i)
      first[i] = static_cast<unsigned int>(array.values[i]);
  }

  /** @param part returns a reference to the member, which consists of doubles alone */
  template <typename Element, typename Part>
  void member(const std::string &name, std::vector<Element> &list, const Part &part)
  {
    using Value = std::remove_reference_t<decltype(part(list[0]))>;
    static_assert(std::is_trivially_copyable<Value>::value && sizeof(Value) % sizeof(double) == 0,
                  "only what consists of doubles");
    constexpr std::size_t columns = sizeof(Value) / sizeof(double);
    if (is_packing)
    {
      NamedArrays::Array array;
      array.columns = columns;
      array.values.reserve(list.size() * columns);
      for (auto &element : list)
      {
        const auto *const first = reinterpret_cast<const double *>(&part(element));
        array.values.insert(array.values.end(), first, first + columns);
      }
      arrays.set(prefix + name, std::move(array));
      return;
    }
    const NamedArrays::Array &array = get(name, columns);
    list.resize(array.values.size() / columns);
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      auto *const first = reinterpret_cast<double *>(&part(list[i]));
      std::copy_n(array.values.begin() + i * columns, columns, first);
    }
  }

private:
  explicit ArrayExchange(const bool is_packing) : is_packing(is_packing) {}

  /** @throws SimulationError unless the array has this shape */
  const NamedArrays::Array &get(const std::string &name, std::size_t columns, std::size_t rows = -1) const;

  const bool is_packing;
  NamedArrays arrays;
  std::string prefix;
};
} // namespace Gemmule
