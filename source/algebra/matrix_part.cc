// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/matrix_part.h>

#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

namespace
{
  using Index = types::global_dof_index;
  using Summands = std::vector<std::pair<const SubassembledMatrix *, double>>;

  /** Rows or columns of the part: their numbers, ascending, and which rows of the sum have which of them. */
  struct Slots
  {
    explicit Slots(const std::vector<MatrixPlace> &places) : slot(places.size()), group(places.size())
    {
      for (const auto &place : places)
        if (place.group != numbers::invalid_unsigned_int)
          number.push_back(place.number);
      std::sort(number.begin(), number.end());
      number.erase(std::unique(number.begin(), number.end()), number.end());
      for (unsigned int i = 0; i < places.size(); ++i)
      {
        group[i] = places[i].group;
        if (is_part(i))
          slot[i] = std::lower_bound(number.begin(), number.end(), places[i].number) - number.begin();
      }
    }
    bool is_part(const unsigned int i) const { return group[i] != numbers::invalid_unsigned_int; }
    unsigned int size() const { return number.size(); }

    std::vector<Index> number;
    std::vector<unsigned int> slot, group;
  };

  /** Adds up entries of rows one row after the other. */
  class RowSums
  {
  public:
    /** @param n columns */
    explicit RowSums(const unsigned int n) : position(n), last_row(n, numbers::invalid_unsigned_int) {}

    void add(const unsigned int row, const unsigned int column, const double value)
    {
      if (last_row[column] != row)
      {
        last_row[column] = row;
        position[column] = columns.size();
        columns.push_back(column);
        values.push_back(0.);
      }
      values[position[column]] += value;
    }
    void finish_row() { start.push_back(columns.size()); }

    std::vector<std::size_t> start{0};
    std::vector<unsigned int> columns; ///< slots
    std::vector<double> values;

  private:
    std::vector<std::size_t> position;
    std::vector<unsigned int> last_row;
  };

  /** Entries sorted into rows by counting. */
  template <typename Entries>
  std::vector<std::pair<unsigned int, double>>
  sort_into_rows(const unsigned int n_rows, const Entries &for_all, std::vector<std::size_t> &start)
  {
    start.assign(n_rows + 1, 0);
    for_all([&](const unsigned int row, unsigned int, double) { ++start[row + 1]; });
    for (unsigned int row = 0; row < n_rows; ++row)
      start[row + 1] += start[row];
    std::vector<std::pair<unsigned int, double>> entries(start[n_rows]);
    std::vector<std::size_t> fill(start.begin(), start.end() - 1);
    for_all(
        [&](const unsigned int row, const unsigned int column, const double value) {
          entries[fill[row]++] = {column, value};
        });
    return entries;
  }

  /** The entries that are stored in the rows of the part, without their mirror images. */
  RowSums collect_stored_entries(const Summands &summands, const Slots &rows, const Slots &columns)
  {
    std::vector<std::size_t> start;
    const auto members = sort_into_rows(
        rows.size(),
        [&](const auto &action)
        {
          for (unsigned int row = 0; row < rows.slot.size(); ++row)
            if (rows.is_part(row))
              action(rows.slot[row], row, 0.);
        },
        start);
    RowSums sums(columns.size());
    for (unsigned int slot = 0; slot < rows.size(); ++slot)
    {
      for (std::size_t m = start[slot]; m < start[slot + 1]; ++m)
      {
        const unsigned int row = members[m].first, group = rows.group[row];
        for (const auto &[matrix, weight] : summands)
          for (std::size_t k = matrix->row_begin(row); k < matrix->row_begin(row + 1); ++k)
            if (const unsigned int column = matrix->column(k); columns.group[column] == group)
              sums.add(slot, columns.slot[column], weight * matrix->entry_values()[k]);
      }
      sums.finish_row();
    }
    return sums;
  }

  /** action(row, column, value) for the mirror images of stored entries that lie in the part. */
  template <typename Action>
  void for_mirrored_entries(const Summands &summands, const Slots &rows, const Slots &columns,
                            const Action &action)
  {
    for (const auto &[matrix, weight] : summands)
      for (unsigned int column = 0; column < matrix->n_rows(); ++column)
        if (columns.is_part(column))
          for (std::size_t k = matrix->row_begin(column); k < matrix->row_begin(column + 1); ++k)
            if (const unsigned int row = matrix->column(k);
                row != column && rows.group[row] == columns.group[column])
              action(rows.slot[row], columns.slot[column], weight * matrix->entry_values()[k]);
  }

  /** All entries of the part that this rank has. */
  RowSums collect_rows(const Summands &summands, const Slots &rows, const Slots &columns)
  {
    RowSums stored = collect_stored_entries(summands, rows, columns);
    const bool is_symmetric = &rows == &columns;
    std::vector<std::size_t> start;
    const auto mirrored = sort_into_rows(
        rows.size(),
        [&](const auto &action)
        {
          // In a symmetric part the sums can be mirrored, which are fewer than what they were added from.
          if (!is_symmetric)
            for_mirrored_entries(summands, rows, columns, action);
          else
            for (unsigned int row = 0; row < rows.size(); ++row)
              for (std::size_t k = stored.start[row]; k < stored.start[row + 1]; ++k)
                if (stored.columns[k] != row)
                  action(stored.columns[k], row, stored.values[k]);
        },
        start);
    if (mirrored.empty())
      return stored;
    RowSums sums(columns.size());
    for (unsigned int row = 0; row < rows.size(); ++row)
    {
      for (std::size_t k = stored.start[row]; k < stored.start[row + 1]; ++k)
        sums.add(row, stored.columns[k], stored.values[k]);
      for (std::size_t k = start[row]; k < start[row + 1]; ++k)
        sums.add(row, mirrored[k].first, mirrored[k].second);
      sums.finish_row();
    }
    return sums;
  }
} // namespace

void extract_part(const std::vector<std::pair<const SubassembledMatrix *, double>> &summands,
                  const MatrixPart &part, const MPI_Comm communicator, TrilinosWrappers::SparseMatrix &matrix)
{
  for (const auto &summand : summands)
    AssertThrow(summand.first->is_symmetric(), ExcNotImplemented());
  const bool is_symmetric = part.columns.empty();
  const Slots row_slots(part.rows), other_slots(part.columns);
  const Slots &column_slots = is_symmetric ? row_slots : other_slots;
  const RowSums rows = collect_rows(summands, row_slots, column_slots);
  std::vector<Index> columns;
  columns.reserve(rows.columns.size());
  for (const unsigned int slot : rows.columns)
    columns.push_back(column_slots.number[slot]);

  IndexSet writable(part.owned_rows.size());
  writable.add_indices(row_slots.number.begin(), row_slots.number.end());
  writable.add_indices(part.owned_rows);
  writable.compress();
  const IndexSet &owned_columns = is_symmetric ? part.owned_rows : part.owned_columns;
  TrilinosWrappers::SparsityPattern pattern(part.owned_rows, owned_columns, writable, communicator);
  for (unsigned int row = 0; row < row_slots.number.size(); ++row)
    pattern.add_entries(row_slots.number[row], columns.begin() + rows.start[row],
                        columns.begin() + rows.start[row + 1]);
  pattern.compress();

  matrix.reinit(pattern);
  for (unsigned int row = 0; row < row_slots.number.size(); ++row)
    if (rows.start[row + 1] > rows.start[row])
      matrix.add(row_slots.number[row], rows.start[row + 1] - rows.start[row],
                 columns.data() + rows.start[row], rows.values.data() + rows.start[row], false);
  matrix.compress(VectorOperation::add);
}
} // namespace Gemmule
