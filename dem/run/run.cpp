#include "dem/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <span>

#include "data/error.hpp"
#include "dem/bed/setup.hpp"
#include "dem/case/grains.hpp"
#include "dem/contact/isa.hpp"
#include "dem/engine/order.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/mixing.hpp"
#include "dem/run/outputs.hpp"
#include "dem/run/summary.hpp"

namespace dem {
namespace {

constexpr double check_interval = 0.05;  // s of simulated time between looks at the standard error

// About so many pictures are averaged over a window, fewer where it has not as many samples. Of 20 ms they are 1.6 ms
// apart, in which what flows moves by a fraction of a sphere. Their number is odd, so that no cell is covered in just
// half of them.
constexpr std::uint64_t pictures_in_window = 12;

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
  std::uint64_t window = 1, picture = 1;            ///< samples
  LookRule rule;
};

Plan make_plan(const Case& c, const Derived& d, const Sensor& sensor) {
  const RunControl& r = c.run;
  const double dt = d.time_step;
  Plan p;
  p.sample = std::max<std::uint64_t>(1, steps_in(r.sample_interval, dt));
  p.settle = steps_in(r.settle, dt);
  p.check = std::max<std::uint64_t>(1, steps_in(check_interval, dt) / p.sample) * p.sample;
  p.window = samples_in_window(r);
  p.picture = std::max<std::uint64_t>(1, p.window / pictures_in_window);
  while ((p.window + p.picture - 1) / p.picture % 2 == 0) ++p.picture;
  p.rule = look_rule(r, static_cast<double>(p.sample) * dt, sensor.period);
  return p;
}

void add_step(const Sampling& of, const Simulation& simulation, Progressing& now) {
  const StepSums& sums = simulation.sums();
  ++now.steps;
  for (std::size_t k = 0; k < now.sums.size(); ++k) now.sums[k] += mean_outputs()[k].at_step(of, simulation);
  now.deep_contacts += sums.deep;
  now.max_overlap = std::max(now.max_overlap, sums.max_overlap);
}

void take_sample(const Sampling& of, const Simulation& simulation, std::uint64_t turning_steps, Checkpoint& now) {
  const double n = static_cast<double>(now.under_way.steps);
  Series& s = now.series;
  s.time.push_back(static_cast<double>(turning_steps) * simulation.setup().time_step);
  for (std::size_t k = 0; k < now.under_way.sums.size(); ++k) {
    const MeanOutput& output = mean_outputs()[k];
    (s.*output.series).push_back(now.under_way.sums[k] / n / output.divisor(of));
    now.under_way.sums[k] = 0.0;
  }
  now.under_way.steps = 0;
  if (!std::isfinite(s.kinetic_energy.back() + s.torque.back())) {
    throw Fault(
        fmt::format("the kinetic energy or torque is not a number at {:.6g} s (a contact too stiff for the time step)",
                    simulation.time()));
  }
}

/// After a sample: the picture, where one is due, and what is measured at the end of a window.
void take_picture(const Sampling& of, const Simulation& simulation, const Plan& plan, Checkpoint& now) {
  if (of.plane.columns == 0) return;
  const std::uint64_t sample = (now.series.time.size() - 1) % plan.window;
  Exposure& exposure = now.under_way.exposure;
  if (sample % plan.picture == 0)
    expose(of.plane, std::span(simulation.state().position).first(simulation.state().particles()), exposure);
  if (sample + 1 < plan.window) return;
  const Silhouette found = silhouette_of(of.plane, exposure);
  now.series.window_time.push_back(now.series.time.back());
  for (const CameraOutput& output : camera_outputs()) (now.series.*output.series).push_back(found.*output.value);
  exposure = {};
}

void look_at_bed(const Simulation& simulation, const Box& box, std::span<const std::uint8_t> colour,
                 std::uint64_t turning_steps, Series& s) {
  const double time = static_cast<double>(turning_steps) * simulation.setup().time_step;
  s.look_time.push_back(time);
  s.bond_order.push_back(bond_order(simulation.state(), box));
  if (colour.empty()) return;
  const ChannelLook look = look_into(simulation.setup().channels, colour, simulation.state());
  s.mixing_index.push_back(look.mixing_index);
  s.channel_mass.insert(s.channel_mass.end(), look.mass.begin(), look.mass.end());
}

void cut(Series& s, std::size_t samples, std::uint64_t window) {
  s.time.resize(std::min(s.time.size(), samples));
  for (const MeanOutput& output : mean_outputs()) (s.*output.series).resize(s.time.size());
  const auto looks = std::upper_bound(s.look_time.begin(), s.look_time.end(), s.time.empty() ? 0.0 : s.time.back());
  s.bond_order.resize(static_cast<std::size_t>(looks - s.look_time.begin()));
  s.look_time.erase(looks, s.look_time.end());
  s.mixing_index.resize(std::min(s.mixing_index.size(), s.look_time.size()));
  s.channel_mass.resize(s.mixing_index.size() * channel_places);
  s.window_time.resize(std::min(s.window_time.size(), s.time.size() / window));
  for (const CameraOutput& output : camera_outputs()) (s.*output.series).resize(s.window_time.size());
}

RunProgress progress_of(const Series& s, const Plan& plan) {
  RunProgress now;
  const double done = static_cast<double>(s.time.size());
  now.fraction = done / static_cast<double>(plan.rule.longest);
  now.simulated = s.time.empty() ? 0.0 : s.time.back();
  if (s.time.size() <= plan.rule.start_up) return now;
  const data::SeriesMean mean =
      data::mean_with_error(std::span(s.torque).subspan(plan.rule.start_up), {.start_up_fraction_max = 0.0});
  now.torque = mean.mean;
  now.relative_error = mean.standard_error / std::abs(mean.mean);
  return now;
}

/// Evenly spaced from the start of turning to the earliest end, in steps of the run.
std::vector<std::uint64_t> frames_in(const Plan& plan, int frames) {
  const double last =
      static_cast<double>(std::min(plan.rule.start_up + plan.rule.shortest, plan.rule.longest) * plan.sample);
  std::vector<std::uint64_t> steps;
  for (int k = 0; k < frames; ++k)
    steps.push_back(plan.settle +
                    (frames == 1 ? 0 : static_cast<std::uint64_t>(std::llround(last * k / (frames - 1.0)))));
  return steps;
}

}  // namespace

std::vector<std::uint64_t> frame_steps(const Case& c, int frames) {
  return frames_in(make_plan(c, derive(c), build_rig(c, 0).sensor), frames);
}

RunResult run(const Case& c, std::uint64_t seed, const RunOptions& options) {
  if (auto found = problems(c); !found.empty()) throw data::InputError(data::ExitStatus::bad_study, std::move(found));
  const Derived d = derive(c);
  BuiltRig rig = build_rig(c, seed);
  const Sensor sensor = rig.sensor;
  const std::size_t spheres = rig.position.size();
  const Box box{rig.low, rig.high, rig.periodic};
  const Sampling sampling{sensor,
                          static_cast<double>(spheres),
                          solid_volume(rig.grains, spheres),
                          solid_mass(rig.grains, spheres),
                          picture_plane(sensor.picture, box, 0.5 * summarise_bed(c).smallest),
                          rig.channels};
  const std::vector<std::uint8_t> colour = colours(rig.channels, rig.position);
  const Plan plan = make_plan(c, d, sensor);
  Looks looks = begin_looks(plan.rule);
  RunResult result;
  result.seed = seed;
  result.diagnostics.derived = d;
  result.diagnostics.threads = options.threads;
  result.diagnostics.isa = isa();
  Checkpoint& now = result.checkpoint;
  now.under_way.sums.resize(mean_outputs().size());
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
    const std::vector<std::uint64_t> frames = frames_in(plan, options.frames);
    std::size_t next_frame = 0;
    const auto take_frame = [&] {
      const std::uint64_t step = simulation.state().step;
      while (next_frame < frames.size() && frames[next_frame] < step) ++next_frame;  // before a restart
      for (; next_frame < frames.size() && frames[next_frame] == step; ++next_frame)
        options.frame(static_cast<int>(next_frame), simulation,
                      static_cast<double>(frames[next_frame] - plan.settle) * simulation.setup().time_step);
    };
    if (!frames.empty() && options.resume == nullptr) take_frame();  // of a run without settling
    Checkpoint good;
    keep(good);
    try {
      for (std::uint64_t look = 0; !done; ++look) {
        simulation.step();
        if (look % 256 == 0 && options.stop.stop_requested()) {
          result.status = RunStatus::interrupted;
          done = true;
        }
        if (!frames.empty()) take_frame();
        if (simulation.state().step <= plan.settle) continue;
        const std::uint64_t turning = simulation.state().step - plan.settle;
        add_step(sampling, simulation, now.under_way);
        if (turning % plan.sample == 0) {
          take_sample(sampling, simulation, turning, now);
          take_picture(sampling, simulation, plan, now);
          take_looks(plan.rule, now.series, looks);
          done = done || looks.ended;
        }
        if (turning % plan.check == 0) {
          look_at_bed(simulation, box, colour, turning, now.series);
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
    cut(now.series, looks.next, plan.window);
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
    std::vector<std::string> names;
    for (const Driven& driven : sensor.driven)
      names.push_back(driven.body < labels.size() ? labels[driven.body].name : "a body");
    result.warnings.push_back(fmt::format("the torque is exactly 0: no sphere ever touched {}", listed(names)));
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
