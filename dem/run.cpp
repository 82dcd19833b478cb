#include "dem/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "data/error.hpp"
#include "dem/isa.hpp"
#include "dem/rig.hpp"
#include "dem/target.hpp"

namespace dem {
namespace {

constexpr double check_interval = 0.05;  // s of simulated time between looks at the standard error

double cpu_time(int threads) {
  timespec t{};
  clock_gettime(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::uint64_t steps_in(double duration, double time_step) {
  return static_cast<std::uint64_t>(std::llround(duration / time_step));
}

/// The run's plan in whole steps.
struct Plan {
  std::uint64_t settle, sample, start_up, shortest, longest, check;  ///< steps; start_up and on count from turning
};

Plan make_plan(const Case& c, const Derived& d, const Sensor& sensor) {
  const RunControl& r = c.run;
  const double dt = d.time_step;
  Plan p{};
  p.sample = std::max<std::uint64_t>(1, steps_in(r.sample_interval, dt));
  p.settle = steps_in(r.settle, dt);
  p.start_up = steps_in(r.start_up, dt);
  p.longest = std::max(steps_in(r.longest, dt), p.start_up + p.sample);
  p.shortest = std::min(p.longest, p.start_up + steps_in(std::max(r.shortest, r.shortest_turns * sensor.period), dt));
  p.check = std::max<std::uint64_t>(1, steps_in(check_interval, dt) / p.sample) * p.sample;
  return p;
}

std::span<const double> after(const Series& series, const std::vector<double>& values, double start_up) {
  const auto first = std::upper_bound(series.time.begin(), series.time.end(), start_up) - series.time.begin();
  return std::span(values).subspan(static_cast<std::size_t>(first));
}

/// Deviation of the window means; the error is that of independent windows.
data::SeriesMean fluctuation(std::span<const double> torque, std::size_t dropped, std::size_t window) {
  std::vector<double> means;
  for (std::size_t at = dropped; at + window <= torque.size(); at += window) {
    double sum = 0.0;
    for (std::size_t k = 0; k < window; ++k) sum += torque[at + k];
    means.push_back(sum / static_cast<double>(window));
  }
  data::SeriesMean result;
  const double n = static_cast<double>(means.size());
  result.effective_samples = n;
  result.dropped = dropped;
  result.reliable = means.size() >= 8;
  if (means.size() < 2) {
    result.mean = result.standard_error = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  double mean = 0.0, square = 0.0;
  for (const double m : means) mean += m / n;
  for (const double m : means) square += (m - mean) * (m - mean);
  result.mean = std::sqrt(square / (n - 1.0));
  result.standard_error = result.mean / std::sqrt(2.0 * (n - 1.0));
  result.sd = result.standard_error * std::sqrt(n);
  return result;
}

Summary summarise(const Case& c, const Series& s) {
  Summary summary;
  const double start = c.run.start_up;
  const std::span<const double> torque = after(s, s.torque, start);
  const data::SeriesMean mean = data::mean_with_error(torque);
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(c.run.window / c.run.sample_interval)));
  summary.mean = {mean, fluctuation(torque, mean.dropped, window)};
  for (const std::vector<double>* values : {&s.axial_flow, &s.coordination, &s.kinetic_energy, &s.normal_stress}) {
    summary.mean.push_back(data::mean_with_error(after(s, *values, start)));
  }
  summary.reached_target = mean.standard_error <= c.run.standard_error * std::abs(mean.mean);
  return summary;
}

/// What does not change from sample to sample.
struct Sampling {
  Sensor sensor;
  double solid_volume = 0.0;  ///< m3
};

void take_sample(const Sampling& of, const Simulation& simulation, std::uint64_t turning_steps, Checkpoint& now) {
  const Sensor& sensor = of.sensor;
  const double n = static_cast<double>(now.under_way.steps),
               spheres = static_cast<double>(simulation.state().particles());
  const double momentum = dot(sensor.flow_axis, simulation.momentum());
  Series& s = now.series;
  s.time.push_back(static_cast<double>(turning_steps) * simulation.setup().time_step);
  s.torque.push_back(now.under_way.torque / n);
  s.axial_flow.push_back(momentum / sensor.flow_length);
  s.coordination.push_back(2.0 * now.under_way.contacts / n / spheres);
  s.kinetic_energy.push_back(simulation.kinetic_energy());
  s.normal_stress.push_back(now.under_way.virial / n / (3.0 * of.solid_volume));
  now.under_way.steps = 0;
  now.under_way.torque = now.under_way.contacts = now.under_way.virial = 0.0;
  if (!std::isfinite(s.kinetic_energy.back() + s.torque.back())) {
    throw Fault(
        fmt::format("the kinetic energy or torque is not a number at {:.6g} s (a contact too stiff for the time step)",
                    simulation.time()));
  }
}

}  // namespace

const std::vector<Output>& outputs() {
  static const std::vector<Output> all{{"torque", "N m"},     {"torque_fluctuation", "N m"}, {"axial_flow", "kg/s"},
                                       {"coordination", "1"}, {"kinetic_energy", "J"},       {"normal_stress", "Pa"}};
  return all;
}

bool has_output(std::string_view name) {
  return std::any_of(outputs().begin(), outputs().end(), [&](const Output& o) { return o.name == name; });
}

std::string output_names() {
  std::string text;
  for (const Output& o : outputs()) text += (text.empty() ? "" : ", ") + o.name;
  return text;
}

const data::SeriesMean& output(const RunResult& result, std::string_view name) {
  for (std::size_t k = 0; k < outputs().size(); ++k) {
    if (outputs()[k].name == name) return result.summary.mean.at(k);
  }
  throw std::out_of_range(fmt::format("no output named {}", name));
}

RunResult run(const Case& c, std::uint64_t seed, const RunOptions& options) {
  if (auto found = problems(c); !found.empty()) throw data::InputError(data::ExitStatus::bad_study, std::move(found));
  const Derived d = derive(c);
  BuiltRig rig = build_rig(c, seed);
  const Sensor sensor = rig.sensor;
  const Sampling sampling{sensor, solid_volume(rig.grains, rig.position.size())};
  const Plan plan = make_plan(c, d, sensor);
  RunResult result;
  result.seed = seed;
  result.diagnostics.derived = d;
  result.diagnostics.threads = options.threads;
  result.diagnostics.isa = isa();
  Checkpoint& now = result.checkpoint;
  using Clock = std::chrono::steady_clock;
  auto saved = Clock::now();
  const double cpu_before = cpu_time(options.threads);
  double cpu_earlier = 0.0;

  try {
    Simulation simulation(make_setup(c, std::move(rig), plan.settle, options.threads));
    if (options.resume != nullptr) {
      now = *options.resume;
      cpu_earlier = now.under_way.cpu_seconds;
      simulation.restore(std::move(now.state));
      now.state = {};
    }
    // A state is large, so `now` goes without: only what is kept has one, in the memory of the one kept before.
    const auto keep = [&](Checkpoint& kept) {
      now.under_way.cpu_seconds = cpu_earlier + cpu_time(options.threads) - cpu_before;
      kept = now;
      kept.state = simulation.state();
    };
    bool done = false;
    Checkpoint good;
    keep(good);
    try {
      for (std::uint64_t look = 0; !done; ++look) {
        simulation.step();
        if (look % 256 == 0 && options.stop.stop_requested()) {
          result.status = RunStatus::interrupted;
          done = true;
        }
        if (simulation.state().step <= plan.settle) continue;
        const std::uint64_t turning = simulation.state().step - plan.settle;
        const StepSums& sums = simulation.sums();
        ++now.under_way.steps;
        now.under_way.torque += dot(sensor.torque_axis, sums.body[sensor.body].torque);
        now.under_way.contacts += static_cast<double>(sums.contacts);
        now.under_way.virial += sums.virial;
        now.under_way.deep_contacts += sums.deep;
        now.under_way.max_overlap = std::max(now.under_way.max_overlap, sums.max_overlap);
        if (turning % plan.sample == 0) take_sample(sampling, simulation, turning, now);
        if (turning % plan.check == 0 || turning >= plan.longest) {
          keep(good);
          double torque = 0.0, error = 1.0;
          if (turning > plan.start_up) {
            const data::SeriesMean mean = data::mean_with_error(after(now.series, now.series.torque, c.run.start_up));
            torque = mean.mean;
            error = mean.standard_error / std::abs(mean.mean);
            if (turning >= plan.shortest && error <= c.run.standard_error) done = true;
          }
          if (turning >= plan.longest) done = true;
          if (options.progress) {
            options.progress({static_cast<double>(turning) / static_cast<double>(plan.longest),
                              static_cast<double>(turning) * d.time_step, torque, error});
          }
        }
        if (options.checkpoint && look % 256 == 0 &&
            std::chrono::duration<double>(Clock::now() - saved).count() > options.checkpoint_interval) {
          Checkpoint here;
          keep(here);
          options.checkpoint(here);
          saved = Clock::now();
        }
      }
    } catch (const Fault& fault) {
      result.status = RunStatus::failed;
      result.reason = fault.what();
    }
    if (result.status != RunStatus::failed) keep(good);
    now = std::move(good);
    result.diagnostics.steps = simulation.state().step;
    result.diagnostics.rebuilds = simulation.state().rebuilds;
    result.diagnostics.bytes_per_particle = simulation.bytes_per_particle();
  } catch (const Fault& fault) {
    result.status = RunStatus::failed;
    result.reason = fault.what();
  }

  result.series = now.series;
  result.summary = summarise(c, now.series);
  result.summary.cpu_seconds = now.under_way.cpu_seconds;
  Diagnostics& g = result.diagnostics;
  g.deep_contacts = now.under_way.deep_contacts;
  g.max_overlap = now.under_way.max_overlap;
  g.simulated = now.series.time.empty() ? 0.0 : now.series.time.back();
  if (result.summary.cpu_seconds > 0.0) {
    g.steps_per_second = static_cast<double>(g.steps) * static_cast<double>(d.spheres) / result.summary.cpu_seconds;
  }
  if (g.deep_contacts > 0) {
    result.warnings.push_back(fmt::format(
        "{} contact-steps overlap by more than {:g} of a radius, half of run.overlap_limit (largest {:.3g}): raise {}",
        g.deep_contacts, 0.5 * c.run.overlap_limit, g.max_overlap,
        c.contact.normal == NormalLaw::linear ? "contact.stiffness" : "contact.young_modulus"));
  }
  return result;
}

}  // namespace dem
