// Samplers against densities that fool them: what is called converged must be right. The hidden table runs each
// adversary from 20 seeds and stands in uq/infer/SAMPLERS.md: test_uq_infer "[weekly]" -s
#include <catch2/catch.hpp>
#include <cstdio>
#include <ctime>

#include "tests/uq/infer/adversaries.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/infer/nuts.hpp"

using namespace uq;

namespace {

/// Largest error of a mean or standard deviation, in true standard deviations.
double error_of(const Draws& draws, const adversaries::Adversary& adversary) {
  const Eigen::MatrixXd all = draws.pooled();
  double largest = 0.0;
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    if (std::isnan(adversary.sd[k])) continue;
    const double mean = all.col(k).mean(), sd = std::sqrt((all.col(k).array() - mean).square().mean());
    largest =
        std::max({largest, std::abs(mean - adversary.mean[k]) / adversary.sd[k], std::abs(sd / adversary.sd[k] - 1.0)});
  }
  return largest;
}

/// What a converged result may be wrong by: four standard errors at the effective size that is asked for, 0.13.
constexpr double right = 0.15;

struct Tally {
  int right = 0, not_converged = 0, wrong = 0;
  double evidence_square = 0.0;  // of (log evidence - truth) / its error, over the converged
  double seconds = 0.0;
  std::string reason;
};

template <class Sample>
Tally tally(const adversaries::Adversary& adversary, int seeds, const Sample& sample) {
  Tally found;
  const std::clock_t start = std::clock();
  for (int seed = 1; seed <= seeds; ++seed) {
    const Draws draws = sample(adversary.target, static_cast<std::uint64_t>(seed));
    if (!draws.converged) {
      ++found.not_converged;
      found.reason = draws.reason;
      continue;
    }
    ++(error_of(draws, adversary) < right ? found.right : found.wrong);
    if (!std::isnan(draws.log_evidence) && !std::isnan(adversary.log_evidence))
      found.evidence_square += std::pow((draws.log_evidence - adversary.log_evidence) / draws.log_evidence_error, 2);
  }
  found.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / seeds;
  return found;
}

Draws by_mixture(const Target& target, std::uint64_t seed) {
  return sample_mixture(target, {.threads = 1, .seed = seed});
}
Draws by_nuts(const Target& target, std::uint64_t seed) { return sample_nuts(target, {.threads = 1, .seed = seed}); }

}  // namespace

TEST_CASE("two modes of very different widths both have their draws", "[uq]") {
  for (const auto& adversary : {adversaries::narrow_and_wide(2), adversaries::narrow_and_wide(3), adversaries::askew(2),
                                adversaries::mirror(), adversaries::four_values()}) {
    const Tally found = tally(adversary, 5, by_mixture);
    INFO(adversary.name << ": " << found.reason);
    CHECK(found.right == 5);
    // Squares of five standard normal numbers stay below 25 but for one in 7,000.
    CHECK(found.evidence_square < 25.0);
  }
}

TEST_CASE("nothing that fools a sampler is called converged and wrong", "[uq][slow]") {
  for (const auto& adversary : {adversaries::narrow_and_wide(5), adversaries::askew(3), adversaries::spike(2, 0.003),
                                adversaries::cubic_ridge(0.1), adversaries::cubic_ridge(0.001),
                                adversaries::ring(2, 0.001), adversaries::funnel(2), adversaries::funnel(4),
                                adversaries::hyperbola(0.001), adversaries::known_sum(8, 0.05)}) {
    const Tally found = tally(adversary, 3, by_mixture);
    INFO(adversary.name << ": " << found.right << " right, " << found.not_converged << " not converged");
    CHECK(found.wrong == 0);
  }
}

TEST_CASE("NUTS that sits in one of two modes says which it missed", "[uq]") {
  const adversaries::Adversary adversary = adversaries::mirror();
  const Tally found = tally(adversary, 4, by_nuts);
  INFO(found.reason);
  CHECK(found.wrong == 0);
  CHECK(found.not_converged > 0);
}

namespace {

void print_line(const std::string& name, const Tally& found) {
  const int converged = found.right + found.wrong;
  std::printf("| %s | %d | %d | %d | %.1f | %.2f |\n", name.c_str(), found.right, found.not_converged, found.wrong,
              converged > 0 ? std::sqrt(found.evidence_square / converged) : 0.0, found.seconds);
  std::fflush(stdout);
  CHECK(found.wrong == 0);
}

void print_head() {
  std::printf(
      "| density | right | not converged | converged and wrong | rms of the evidence's error, in its own | CPU, s "
      "|\n|---|---|---|---|---|---|\n");
}

}  // namespace

TEST_CASE("the table of adversaries, 20 seeds each", "[.][weekly]") {
  print_head();
  for (const auto& adversary : adversaries::all()) print_line(adversary.name, tally(adversary, 20, by_mixture));
  for (const auto& adversary : {adversaries::mirror(), adversaries::narrow_and_wide(2), adversaries::four_values()})
    print_line("NUTS: " + adversary.name, tally(adversary, 20, by_nuts));
}

TEST_CASE("the table of adversaries in eight and ten dimensions, 20 seeds each", "[.][weekly]") {
  print_head();
  for (const auto& adversary : adversaries::many_dimensions())
    print_line(adversary.name, tally(adversary, 20, by_mixture));
}
