#include "tests/uq/verdict/verdict_structures.hpp"

#include <cmath>
#include <numbers>

namespace verdict_suite {
namespace {

using uq::Reason;
using uq::Verdict;
using Vector = Eigen::VectorXd;

const Expected known{.words = {Verdict::identified}, .reasons = {}};
const Expected structural{.words = {Verdict::not_identified}, .reasons = {Reason::structural}};
const Expected wide{.words = {Verdict::not_identified, Verdict::weakly_identified}, .reasons = {}};
/// The data say something of it, whatever the word.
const Expected seen{.words = {Verdict::identified, Verdict::weakly_identified, Verdict::not_identified},
                    .reasons = {Reason::bound, Reason::one_sided, Reason::surrogate, Reason::practical}};
const Expected silent{.words = {Verdict::not_identified}, .reasons = {Reason::no_influence}};
/// Not structural: another data set may end such an interval on one side by chance, where a combination is known, too.
const Expected hidden{
    .words = {Verdict::not_identified},
    .reasons = {Reason::practical, Reason::surrogate, Reason::one_sided, Reason::bound, Reason::traded}};
const Expected limited{.words = {Verdict::not_identified}, .reasons = {Reason::one_sided}};
const Expected upper{.words = {Verdict::weakly_identified}, .reasons = {Reason::bound}};
const Expected misfit{.words = {Verdict::does_not_fit}, .reasons = {}};

Expected separate(int values) { return {.words = {Verdict::several_values}, .reasons = {}, .values = values}; }

Vector at(std::initializer_list<double> values) {
  Vector truth(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) truth[i++] = value;
  return truth;
}

std::vector<Range> same(std::size_t count, double low, double high) {
  return std::vector<Range>(count, Range{low, high});
}

void add_known(std::vector<Structure>& all) {
  all.push_back({.what = "two effects of different shape",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * (1.0 + z) + p[1] * (1.0 - z * z); },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.4, 0.6}),
                 .expected = {known, known}});
  all.push_back(
      {.what = "three effects of different shape",
       .formula = [](const Vector& p, double z) { return 1.0 + p[0] + 2.0 * p[1] * z + 4.0 * p[2] * z * (1.0 - z); },
       .ranges = same(3, 0.0, 1.0),
       .truth = at({0.4, 0.6, 0.5}),
       .expected = {known, known, known}});
  all.push_back({.what = "a decay",
                 .formula = [](const Vector& p, double z) { return p[0] * std::exp(-3.0 * p[1] * z); },
                 .ranges = same(2, 0.2, 1.2),
                 .truth = at({0.8, 0.6}),
                 .expected = {known, known}});
  all.push_back({.what = "a square on one side of zero",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * p[0] * (1.0 + z); },
                 .ranges = same(1, 0.0, 2.0),
                 .truth = at({0.9}),
                 .expected = {known}});
  all.push_back({.what = "a quotient whose parts show elsewhere",
                 .formula = [](const Vector& p, double z) { return (1.0 - z) * p[0] / p[1] + z * p[1]; },
                 .ranges = same(2, 0.5, 2.0),
                 .truth = at({1.0, 1.2}),
                 .expected = {known, known}});
  all.push_back({.what = "noise that grows with the control",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * (1.0 + z) + p[1] * (1.0 - z * z); },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.4, 0.6}),
                 .expected = {known, known},
                 .noise_shape = [](double z) { return 0.3 + 1.4 * z; }});
}

void add_products(std::vector<Structure>& all) {
  all.push_back({.what = "product of two",
                 .formula = [](const Vector& p, double z) { return p[0] * p[1] * (1.0 + 0.5 * z); },
                 .ranges = same(2, 0.2, 2.0),
                 .truth = at({1.1, 0.9}),
                 .expected = {structural, structural},
                 .together = {{{"p1", "p2"}, "p1 * p2"}}});
  all.push_back({.what = "product of three",
                 .formula = [](const Vector& p, double z) { return p[0] * p[1] * p[2] * (1.0 + 0.5 * z); },
                 .ranges = same(3, 0.4, 1.6),
                 .truth = at({1.1, 0.9, 1.0}),
                 .expected = {structural, structural, structural},
                 .together = {{{"p1", "p2", "p3"}, "p1 * p2 * p3"}},
                 .runs = 120});
  all.push_back({.what = "quotient of two",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] / p[1] * (1.0 + 0.5 * z); },
                 .ranges = {{0.4, 2.0}, {1.0, 3.0}},
                 .truth = at({1.0, 2.0}),
                 .expected = {structural, structural},
                 .together = {{{"p1", "p2"}, "p1 / p2"}}});
  all.push_back({.what = "quotient of three",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * p[1] / p[2] * (1.0 + 0.5 * z); },
                 .ranges = same(3, 0.5, 1.5),
                 .truth = at({1.0, 0.9, 1.1}),
                 .expected = {structural, structural, structural},
                 .together = {{{"p1", "p2", "p3"}, "p1 * p2 / p3"}},
                 .runs = 120});
  all.push_back({.what = "a power in a product",
                 .formula = [](const Vector& p, double z) { return p[0] * p[1] * p[1] * (1.0 + 0.5 * z); },
                 .ranges = {{0.2, 1.2}, {0.8, 2.0}},
                 .truth = at({0.6, 1.3}),
                 .expected = {structural, structural},
                 .together = {{{"p1", "p2"}, "p1 * p2^2"}}});
  all.push_back({.what = "product beside a known effect",
                 .formula = [](const Vector& p, double z) { return p[0] * p[1] + 2.0 * p[2] * z; },
                 .ranges = same(3, 0.2, 1.5),
                 .truth = at({0.9, 0.7, 0.8}),
                 .expected = {structural, structural, known},
                 .together = {{{"p1", "p2"}, "p1 * p2"}},
                 .runs = 120});
  all.push_back({.what = "far from saturation only a quotient shows",
                 .formula = [](const Vector& p, double z) { return p[0] * z / (p[1] + 0.1 * z); },
                 .ranges = {{1.0, 4.0}, {3.0, 9.0}},
                 .truth = at({2.4, 5.5}),
                 .expected = {wide, wide},
                 .together = {{{"p1", "p2"}, ""}}});
}

void add_sums(std::vector<Structure>& all) {
  all.push_back({.what = "sum of two",
                 .formula = [](const Vector& p, double z) { return 4.0 + (p[0] + p[1]) * (1.0 + z); },
                 .ranges = same(2, -1.0, 1.0),
                 .truth = at({0.3, -0.1}),
                 .expected = {structural, structural},
                 .together = {{{"p1", "p2"}, "p1 + p2"}}});
  all.push_back({.what = "sum of three",
                 .formula = [](const Vector& p, double z) { return 4.0 + (p[0] + p[1] + p[2]) * (1.0 + z); },
                 .ranges = same(3, -1.0, 1.0),
                 .truth = at({0.3, -0.2, 0.2}),
                 .expected = {structural, structural, structural},
                 .together = {{{"p1", "p2", "p3"}, "p1 + p2 + p3"}},
                 .runs = 100});
  all.push_back({.what = "difference of two",
                 .formula = [](const Vector& p, double z) { return 4.0 + (p[0] - p[1]) * (1.0 + z); },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.5, 0.4}),
                 .expected = {structural, structural},
                 .together = {{{"p1", "p2"}, "p1 - p2"}}});
  all.push_back({.what = "a weighted sum",
                 .formula = [](const Vector& p, double z) { return 4.0 + (p[0] + 0.5 * p[1]) * (1.0 + z); },
                 .ranges = same(2, 0.0, 2.0),
                 .truth = at({1.0, 0.9}),
                 .expected = {structural, structural},
                 .together = {{{"p1", "p2"}, "p1 + 0.5 x p2"}}});
  all.push_back({.what = "two sums at once",
                 .formula = [](const Vector& p, double z) { return 4.0 + p[0] + p[1] + 2.0 * z * (p[2] + p[3]); },
                 .ranges = same(4, 0.0, 1.0),
                 .truth = at({0.5, 0.4, 0.6, 0.4}),
                 .expected = {structural, structural, structural, structural},
                 .together = {{{"p1", "p2"}, "p1 + p2"}, {{"p3", "p4"}, "p3 + p4"}},
                 .runs = 120});
  all.push_back({.what = "a sum that only noise confounds",
                 .formula = [](const Vector& p, double z) { return 4.0 + p[0] + p[1] * (1.0 + 0.3 * z); },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.5, 0.5}),
                 .expected = {hidden, hidden},
                 .together = {{{"p1", "p2"}, ""}},
                 .run_noise = 0.0005,
                 .data_noise = 0.03,
                 .runs = 100});
  all.push_back({.what = "a circle",
                 .formula = [](const Vector& p, double z) { return 2.0 + (p[0] * p[0] + p[1] * p[1]) * (1.0 + z); },
                 .ranges = same(2, -1.5, 1.5),
                 .truth = at({0.6, 0.8}),
                 .expected = {wide, wide},
                 .together = {{{"p1", "p2"}, ""}},
                 .runs = 120});
  all.push_back({.what = "a parabola",
                 .formula = [](const Vector& p, double z) { return 5.0 + (p[1] - p[0] * p[0]) * (1.0 + z); },
                 .ranges = {{-1.5, 1.5}, {-1.0, 2.0}},
                 .truth = at({0.6, 0.8}),
                 .expected = {wide, wide},
                 .together = {{{"p1", "p2"}, ""}},
                 .runs = 120});
}

void add_values(std::vector<Structure>& all) {
  all.push_back({.what = "a mirror",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * p[0] * (1.0 + z) + p[1] * z; },
                 .ranges = {{-2.0, 2.0}, {-1.0, 1.0}},
                 .truth = at({0.8, 0.2}),
                 .expected = {separate(2), known},
                 .runs = 120});
  all.push_back(
      {.what = "a wave of two periods",
       .formula = [](const Vector& p, double z) { return 2.0 + std::sin(4.0 * std::numbers::pi * p[0]) + p[1] * z; },
       .ranges = {{0.0, 1.0}, {-1.0, 1.0}},
       .truth = at({0.08, 0.3}),
       .expected = {separate(4), known},
       .runs = 120});
  all.push_back(
      {.what = "two roots",
       .formula = [](const Vector& p, double z) { return 3.0 + 20.0 * (p[0] - 0.3) * (p[0] - 0.7) + p[1] * z; },
       .ranges = same(2, 0.0, 1.0),
       .truth = at({0.3, 0.5}),
       .expected = {separate(2), known},
       .runs = 100});
  all.push_back({.what = "two mirrors",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * p[0] * (1.0 - z) + p[1] * p[1] * z; },
                 .ranges = same(2, -2.0, 2.0),
                 .truth = at({0.9, -1.1}),
                 .expected = {separate(2), separate(2)},
                 .runs = 120});
  all.push_back({.what = "two effects that may be exchanged",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] + p[1] + 3.0 * p[0] * p[1] * z; },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.2, 0.8}),
                 .expected = {separate(2), separate(2)},
                 .runs = 120});
}

void add_silent(std::vector<Structure>& all) {
  const auto one = [](const Vector& p, double z) { return 1.0 + p[0] * (1.0 + z); };
  all.push_back({.what = "one without influence, noisy runs",
                 .formula = one,
                 .ranges = same(2, 0.1, 2.0),
                 .truth = at({0.9, 1.0}),
                 .expected = {known, silent},
                 .run_noise = 0.02,
                 .data_noise = 0.02,
                 .runs = 60});
  all.push_back({.what = "two without influence, noisy runs",
                 .formula = one,
                 .ranges = same(3, 0.1, 2.0),
                 .truth = at({0.9, 1.0, 1.0}),
                 .expected = {known, silent, silent},
                 .run_noise = 0.02,
                 .data_noise = 0.02});
  all.push_back({.what = "four without influence, noisy runs",
                 .formula = one,
                 .ranges = same(5, 0.1, 2.0),
                 .truth = at({0.9, 1.0, 1.0, 1.0, 1.0}),
                 .expected = {known, silent, silent, silent, silent},
                 .run_noise = 0.02,
                 .data_noise = 0.02,
                 .runs = 100});
  all.push_back({.what = "one without influence, exact runs",
                 .formula = one,
                 .ranges = same(2, 0.1, 2.0),
                 .truth = at({0.9, 1.0}),
                 .expected = {known, silent},
                 .run_noise = 0.0002,
                 .data_noise = 0.01});
  all.push_back({.what = "none with influence",
                 .formula = [](const Vector&, double z) { return 2.0 + z; },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.5, 0.5}),
                 .expected = {silent, silent},
                 .run_noise = 0.01});
  all.push_back({.what = "product beside one without influence",
                 .formula = [](const Vector& p, double z) { return p[0] * p[1] * (1.0 + 0.5 * z); },
                 .ranges = same(3, 0.2, 2.0),
                 .truth = at({1.1, 0.9, 1.0}),
                 .expected = {structural, structural, silent},
                 .together = {{{"p1", "p2"}, "p1 * p2"}},
                 .run_noise = 0.005,
                 .runs = 120});
  all.push_back(
      {.what = "two effects beside one without influence, noisy runs",
       .formula = [](const Vector& p, double z) { return 1.0 + p[0] * (1.0 + z) + 2.0 * p[1] * (1.0 - z * z); },
       .ranges = same(3, 0.0, 1.0),
       .truth = at({0.4, 0.6, 0.5}),
       .expected = {known, known, silent},
       .run_noise = 0.01,
       .runs = 120});
}

void add_limits(std::vector<Structure>& all) {
  all.push_back({.what = "nothing of a positive effect",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * (0.5 + z); },
                 .ranges = same(1, 0.0, 2.0),
                 .truth = at({0.0}),
                 .expected = {upper},
                 .runs = 40});
  all.push_back({.what = "the lower end of a range",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] * (0.5 + z); },
                 .ranges = same(1, 0.1, 2.0),
                 .truth = at({0.1}),
                 .expected = {limited},
                 .runs = 40});
  all.push_back({.what = "saturated",
                 .formula = [](const Vector& p, double z) { return 1.0 + (1.0 - std::exp(-8.0 * p[0])) * (1.0 + z); },
                 .ranges = same(1, 0.05, 1.0),
                 .truth = at({0.85}),
                 .expected = {limited},
                 .runs = 60});
  all.push_back({.what = "below a threshold",
                 .formula =
                     [](const Vector& p, double z) {
                       const double above = std::max(p[0] - 0.6, 0.0);
                       return 1.0 + 12.0 * above * above * (1.0 + z) + p[1] * z;
                     },
                 .ranges = same(2, 0.1, 1.0),
                 .truth = at({0.3, 0.5}),
                 .expected = {limited, known},
                 .runs = 120});
  all.push_back({.what = "hidden by the measurement's noise",
                 .formula = [](const Vector& p, double z) { return 2.0 + 2.0 * p[0] * z + 0.1 * p[1] * (1.0 - z); },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.5, 0.5}),
                 .expected = {known, hidden},
                 .run_noise = 0.0005,
                 .data_noise = 0.05});
  // Both are narrowed by more than half. Runs of 3 % leave in doubt how much each does over its whole range.
  all.push_back({.what = "steep at the low end, through runs with much noise",
                 .formula =
                     [](const Vector& p, double z) {
                       const double steep = 8.0 * (1.0 - std::exp(-(p[0] - 0.05) / 0.08));
                       return 2.0 + steep + 0.05 * p[1] * std::sqrt(0.5 + 2.5 * z);
                     },
                 .ranges = {{0.1, 0.8}, {0.0, 10.0}},
                 .truth = at({0.1, 2.0}),
                 .expected = {seen, seen},
                 .run_noise = 0.03,
                 .data_noise = 0.015,
                 .runs = 60});
  all.push_back({.what = "a wave that no value explains",
                 .formula = [](const Vector& p, double z) { return 1.0 + p[0] + p[1] * z; },
                 .ranges = same(2, 0.0, 1.0),
                 .truth = at({0.5, 0.5}),
                 .expected = {misfit, misfit},
                 .unmodelled = [](double z) { return 0.12 * std::sin(7.0 * z); }});
}

}  // namespace

std::vector<Structure> structures() {
  std::vector<Structure> all;
  add_known(all);
  add_products(all);
  add_sums(all);
  add_values(all);
  add_silent(all);
  add_limits(all);
  return all;
}

std::string name_of(std::size_t parameter) { return "p" + std::to_string(parameter + 1); }

}  // namespace verdict_suite
