#include "dem/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "data/error.hpp"
#include "dem/isa.hpp"
#include "dem/order.hpp"
#include "dem/rig.hpp"
#include "dem/summary.hpp"
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
  std::uint64_t settle = 0, sample = 1, check = 1;  ///< all but settle count from turning
  LookRule rule;
};

Plan make_plan(const Case& c, const Derived& d, const Sensor& sensor) {
  const RunControl& r = c.run;
  const double dt = d.time_step;
  Plan p;
  p.sample = std::max<std::uint64_t>(1, steps_in(r.sample_interval, dt));
  p.settle = steps_in(r.settle, dt);
  p.check = std::max<std::uint64_t>(1, steps_in(check_interval, dt) / p.sample) * p.sample;
  p.rule = look_rule(r, static_cast<double>(p.sample) * dt, sensor.period);
  return p;
}

/// What does not change from sample to sample.
struct Sampling {
  Sensor sensor;
  double solid_volume = 0.0;  ///< m3
};

void take_sample(const Sampling& of, const Simulation& simulation, std::uint64_t turning_steps, Checkpoint& now) {
  const double n = static_cast<double>(now.under_way.steps),
               spheres = static_cast<double>(simulation.state().particles());
  Series& s = now.series;
  s.time.push_back(static_cast<double>(turning_steps) * simulation.setup().time_step);
  s.torque.push_back(now.under_way.torque / n);
  s.axial_flow.push_back(now.under_way.flow / n / of.sensor.flow_length);
  s.coordination.push_back(2.0 * now.under_way.contacts / n / spheres);
  s.kinetic_energy.push_back(now.under_way.kinetic_energy / n);
  s.normal_stress.push_back(now.under_way.virial / n / (3.0 * of.solid_volume));
  now.under_way.steps = 0;
  now.under_way.torque = now.under_way.contacts = now.under_way.virial = 0.0;
  now.under_way.flow = now.under_way.kinetic_energy = 0.0;
  if (!std::isfinite(s.kinetic_energy.back() + s.torque.back())) {
    throw Fault(
        fmt::format("the kinetic energy or torque is not a number at {:.6g} s (a contact too stiff for the time step)",
                    simulation.time()));
  }
}

void look_at_bed(const Simulation& simulation, const Box& box, std::uint64_t turning_steps, Series& s) {
  const double time = static_cast<double>(turning_steps) * simulation.setup().time_step;
  s.look_time.push_back(time);
  s.bond_order.push_back(bond_order(simulation.state(), box));
}

void cut(Series& s, std::size_t samples) {
  for (std::vector<double>* values :
       {&s.time, &s.torque, &s.axial_flow, &s.coordination, &s.kinetic_energy, &s.normal_stress})
    values->resize(std::min(values->size(), samples));
  const auto looks = std::upper_bound(s.look_time.begin(), s.look_time.end(), s.time.empty() ? 0.0 : s.time.back());
  s.bond_order.resize(static_cast<std::size_t>(looks - s.look_time.begin()));
  s.look_time.erase(looks, s.look_time.end());
}

RunProgress progress_of(const Series& s, const Plan& plan) {
  RunProgress now;
  const double done = static_cast<double>(s.time.size());
  now.fraction = done / static_cast<double>(plan.rule.longest);
  now.simulated = s.time.empty() ? 0.0 : s.time.back();
  if (s.time.size() <= plan.rule.start_up) return now;
  const data::SeriesMean mean = data::mean_with_error(std::span(s.torque).subspan(plan.rule.start_up));
  now.torque = mean.mean;
  now.relative_error = mean.standard_error / std::abs(mean.mean);
  return now;
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
  const Box box{rig.low, rig.high, rig.periodic};
  Looks looks = begin_looks(plan.rule);
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
    take_looks(plan.rule, now.series, looks);  // those of before the restart
    bool done = looks.ended;
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
        now.under_way.flow += dot(sensor.flow_axis, simulation.carried().momentum);
        now.under_way.kinetic_energy += simulation.carried().kinetic_energy;
        now.under_way.deep_contacts += sums.deep;
        now.under_way.max_overlap = std::max(now.under_way.max_overlap, sums.max_overlap);
        if (turning % plan.sample == 0) {
          take_sample(sampling, simulation, turning, now);
          take_looks(plan.rule, now.series, looks);
          done = done || looks.ended;
        }
        if (turning % plan.check == 0) {
          look_at_bed(simulation, box, turning, now.series);
          keep(good);
          if (options.progress) options.progress(progress_of(now.series, plan));
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

  if (looks.ended && looks.next < now.series.time.size()) {  // a longer run is cut to what this case asks for
    cut(now.series, looks.next);
    now.state = {};
  }
  result.series = now.series;
  if (looks.last.count == 0) looks.last = measure(plan.rule, now.series, now.series.time.size());
  result.summary = summarise(c, sensor.period, now.series, looks);
  result.summary.cpu_seconds = now.under_way.cpu_seconds;
  Diagnostics& g = result.diagnostics;
  g.deep_contacts = now.under_way.deep_contacts;
  g.max_overlap = now.under_way.max_overlap;
  g.simulated = now.series.time.empty() ? 0.0 : now.series.time.back();
  if (result.summary.cpu_seconds > 0.0) {
    g.steps_per_second = static_cast<double>(g.steps) * static_cast<double>(d.spheres) / result.summary.cpu_seconds;
  }
  if (result.status == RunStatus::done) result.warnings = warnings_of(c, result.summary);
  if (result.status == RunStatus::done && !now.series.torque.empty() && result.summary.mean.front().mean == 0.0) {
    const std::vector<BodyLabel> labels = body_labels(c);
    result.warnings.push_back(fmt::format("the torque is exactly 0: no sphere ever touched {}",
                                          sensor.body < labels.size() ? labels[sensor.body].name : "a body"));
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
