// The damping for a wanted restitution (collision.hpp).
#include <gsl/gsl_roots.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "dem/contact/collision.hpp"

namespace dem {
namespace {

/// A function for GSL that remembers its values: each is a collision, and Brent's method asks for its best again.
struct Remembered {
  std::function<double(double)> of;
  std::map<double, double> values = {};
  double operator()(double x) {
    const auto [at, is_new] = values.try_emplace(x);
    if (is_new) at->second = of(x);
    return at->second;
  }
};

/// Where f falls through zero between low and high, by Brent's method (R. Brent, Algorithms for Minimization Without
/// Derivatives, 1973, ch. 4): until |f| < 1e-8, or nothing is left between the two ends. Where f has one sign, the end
/// at which it is nearest to zero.
double root_between(double low, double high, Remembered f) {
  if (f(low) <= 0.0) return low;
  if (f(high) >= 0.0) return high;
  gsl_function function{[](double x, void* call) { return (*static_cast<Remembered*>(call))(x); }, &f};
  const std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  gsl_root_fsolver_set(solver.get(), &function, low, high);
  double x = low;
  for (int k = 0; k < 100; ++k) {
    gsl_root_fsolver_iterate(solver.get());
    x = gsl_root_fsolver_root(solver.get());
    const double left = gsl_root_fsolver_x_upper(solver.get()) - gsl_root_fsolver_x_lower(solver.get());
    if (std::abs(f(x)) < 1e-8 || left < 1e-14 * high) break;
  }
  return x;
}

}  // namespace

FoundDamping damping_for(const WantedRestitution& wanted, const BedCoefficients& bed, Encounter e) {
  e.sphere.velocity = {0.0, 0.0, -wanted.speed};
  e.sphere.spin = {};
  if (e.partner) e.partner->velocity = e.partner->spin = {};
  const auto with = [&](double zeta) {
    BedCoefficients damped = bed;
    const auto materials = static_cast<std::size_t>(bed.materials);
    if (e.partner) {
      const std::size_t a = e.sphere.material, b = e.partner->material;
      damped.grain[a * materials + b].damping_ratio = damped.grain[b * materials + a].damping_ratio = zeta;
    } else {
      damped.wall[e.sphere.material * (bed.wall.size() / materials) + e.body].damping_ratio = zeta;
    }
    return collide(*make_force_pass(damped), e);
  };
  // Restitution falls with damping, and is 0 where the pair sticks.
  FoundDamping found;
  found.collision = with(0.0);
  if (found.collision.restitution < wanted.restitution) {
    // Without attraction the two differ by the solver's error only.
    if (found.collision.restitution > wanted.restitution - 1e-6) found.damping_ratio = 0.0;
    return found;
  }
  double high = 1.0;
  while (with(high).restitution > wanted.restitution && high < 1e3) high *= 2.0;
  const double zeta = root_between(0.0, high, {[&](double x) { return with(x).restitution - wanted.restitution; }});
  found.damping_ratio = zeta;
  found.collision = with(zeta);
  return found;
}

}  // namespace dem
