// Single parts of the contact law, held in the hand: what a contact stores and gives up where no collision shows it.
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/contact/forces/compose.hpp"

namespace {

constexpr double time_step = 1e-7;

}  // namespace

TEST_CASE("a JKR contact that tears gives up 7.09 (w^5 R*^4 / E*^2)^(1/3)") {
  // C. Thornton & Z. Ning, Powder Technol. 99:154 (1998), eq. (20): the work between touching and tearing.
  using Law = dem::ContactLaw<dem::JkrNormal, dem::MindlinTangential, dem::NoResistance, dem::NoAttraction>;
  const double modulus = 2e7, radius = 0.2e-3, mass = 1e-6;
  for (const double w : {0.01, 0.05, 0.2}) {
    Law law;
    law.normal.modulus = modulus;
    law.normal.adhesion = w;
    law.tangential.modulus = 8e6;
    const Law::At<double> pair = law.at(mass, radius);
    const double tear = law.normal.range(radius);
    dem::History<double> held;
    held.radius = 1e-6;
    const auto given_up = [&](double gap) {
      return pair({.normal = {0.0, 0.0, 1.0}, .overlap = -gap}, held, time_step).dissipated;
    };
    INFO("work of adhesion " << w << " J/m2, tears at " << tear << " m");
    CHECK(given_up(1.001 * tear) ==
          Approx(7.09 * std::cbrt(std::pow(w, 5) * std::pow(radius, 4) / (modulus * modulus))).epsilon(1e-3));
    CHECK(given_up(0.999 * tear) == 0.0);
  }
}

TEST_CASE("Mindlin's spring, sheared, unloaded, sheared back and loaded again, gives no energy") {
  // C. Thornton, S. Cummins, P. Cleary, Powder Technol. 233:30 (2013): the force is scaled with the contact radius as
  // it shrinks; left alone, the way back takes out (k_1 - k_2) s^2 / 2 more than the way out put in.
  using Law = dem::ContactLaw<dem::HertzNormal, dem::MindlinTangential, dem::NoResistance, dem::NoAttraction>;
  Law law;
  law.normal.modulus = 2e7;
  law.tangential.modulus = 8e6;
  law.tangential.friction = 1e9;  // it never slides
  const Law::At<double> pair = law.at(1e-6, 0.2e-3);
  dem::History<double> history;
  const int steps = 400;
  const double deep = 2e-6, shallow = 0.2e-6, slip = 1e-7;
  double work = 0.0, put_in = 0.0;
  const auto move = [&](double overlap, double along) {
    const dem::Reaction<double> r = pair(
        {.normal = {0.0, 0.0, 1.0}, .overlap = overlap, .velocity = {along / time_step, 0.0, 0.0}}, history, time_step);
    work -= r.tangential.x * along;
    history = r.history;
  };
  move(deep, 0.0);
  for (int i = 0; i < steps; ++i) move(deep, slip / steps);
  put_in = work;
  for (int i = 1; i <= steps; ++i) move(deep + (shallow - deep) * i / steps, 0.0);
  for (int i = 0; i < steps; ++i) move(shallow, -slip / steps);
  CHECK(put_in == Approx(0.5 * 8.0 * 8e6 * std::sqrt(0.2e-3 * deep) * slip * slip).epsilon(0.01));
  CHECK(work == Approx(put_in * (1.0 - std::sqrt(shallow / deep))).epsilon(0.01));
}
