// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/cut_quadrature.h>

#include <deal.II/base/exceptions.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Assertions of deal.II throw instead of ending the program, as long as this object lives. */
  class ThrowingAssertions
  {
  public:
    ThrowingAssertions() { deal_II_exceptions::disable_abort_on_exception(); }
    ~ThrowingAssertions()
    {
      if (aborted_before)
        deal_II_exceptions::enable_abort_on_exception();
    }
    ThrowingAssertions(const ThrowingAssertions &) = delete;
    ThrowingAssertions &operator=(const ThrowingAssertions &) = delete;

  private:
    const bool aborted_before = deal_II_exceptions::internals::allow_abort_on_exception;
  };
} // namespace

template <int dim>
BoundingBox<dim> unit_box()
{
  Point<dim> one;
  for (unsigned int d = 0; d < dim; ++d)
    one[d] = 1.;
  return BoundingBox<dim>(std::make_pair(Point<dim>(), one));
}

template <int dim>
bool generate_cut_quadrature(NonMatching::QuadratureGenerator<dim> &generator,
                             const CellLevelSet<dim> &level_set, const BoundingBox<dim> &unit_box)
{
  const ThrowingAssertions throwing_assertions;
  try
  {
    generator.generate(level_set, unit_box);
    return true;
  }
  catch (const ExceptionBase &)
  {
    return false;
  }
}

template BoundingBox<2> unit_box();
template BoundingBox<3> unit_box();
template bool generate_cut_quadrature(NonMatching::QuadratureGenerator<2> &, const CellLevelSet<2> &,
                                      const BoundingBox<2> &);
template bool generate_cut_quadrature(NonMatching::QuadratureGenerator<3> &, const CellLevelSet<3> &,
                                      const BoundingBox<3> &);
} // namespace Gemmule
