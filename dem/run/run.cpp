#include "dem/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>
#include <span>

#include "dem/bed/setup.hpp"
#include "dem/case/grains.hpp"
#include "dem/contact/isa.hpp"
#include "dem/engine/order.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/rig/drive.hpp"
#include "dem/run/mixing.hpp"
#include "dem/run/outputs.hpp"
#include "dem/run/summary.hpp"

namespace dem {
namespace {

constexpr double check_interval = 0.05;  // s of simulated time between looks at the standard error

// About so many pictures are averaged over a window, fewer where it has not as many samples. Of 20 ms they are 1.6 ms
// apart, in which what flows moves by a fraction of a sphere. The number that is taken is made odd (`make_plan`), so
// that no cell is covered in just half of them.
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
  double sample_time = 0.0;                         ///< s
  std::uint64_t window = 1, picture = 1;            ///< samples
  LookRule rule;
};

/// `turn` is the time of a turn, 0 where nothing turns [s].
Plan make_plan(const Case& c, const Derived& d, double turn) {
  const RunControl& r = c.run;
  const double dt = d.time_step;
  Plan p;
  p.sample = std::max<std::uint64_t>(1, steps_in(r.sample_interval, dt));
  p.settle = steps_in(r.settle, dt);
  p.check = std::max<std::uint64_t>(1, steps_in(check_interval, dt) / p.sample) * p.sample;
  p.sample_time = static_cast<double>(p.sample) * dt;
  p.window = samples_in_window(r, p.sample_time);
  p.picture = std::max<std::uint64_t>(1, p.window / pictures_in_window);
  while ((p.window + p.picture - 1) / p.picture % 2 == 0) ++p.picture;
  p.rule = look_rule(r, p.sample_time, turn);
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

Sampling sampling_of(const Case& c, const BuiltRig& rig) {
  const std::size_t spheres = rig.position.size();
  std::vector<std::size_t> others;
  for (std::size_t b = 0; b < rig.bodies.size(); ++b)
    if (std::none_of(rig.sensor.driven.begin(), rig.sensor.driven.end(), [&](const Driven& d) { return d.body == b; }))
      others.push_back(b);
  return {rig.sensor,
          std::move(others),
          static_cast<double>(spheres),
          solid_volume(rig.grains, spheres),
          solid_mass(rig.grains, spheres),
          picture_plane(rig.sensor.picture, {rig.low, rig.high, rig.periodic}, 0.5 * summarise_bed(c).smallest),
          rig.channels};
}

/// One run on its way: it steps, samples, looks whether it may end, and keeps what it needs to go on.
class Course {
 public:
  Course(const PreparedCase& prepared, std::uint64_t seed, const RunOptions& options)
      : case_(prepared.given()),
        derived_(prepared.derived()),
        options_(options),
        rig_(build_rig(case_, seed)),
        sensor_(rig_.sensor),
        box_{rig_.low, rig_.high, rig_.periodic},
        sampling_(sampling_of(case_, rig_)),
        colour_(colours(rig_.channels, rig_.position)),
        plan_(make_plan(case_, derived_, sensor_.period)),
        looks_(begin_looks(plan_.rule)),
        frames_(frames_in(plan_, options.frames)),
        cpu_before_(cpu_time(options.threads)) {
    result_.seed = seed;
    result_.diagnostics.derived = derived_;
    result_.diagnostics.threads = options.threads;
    result_.diagnostics.isa = isa();
    now().under_way.sums.resize(mean_outputs().size());
  }

  /// Begins from the start, or from the checkpoint that the run resumes. Throws Fault.
  void begin() {
    simulation_.emplace(make_setup(case_, derived_, std::move(rig_), plan_.settle, options_.threads));
    if (options_.resume != nullptr) {
      now() = *options_.resume;
      cpu_earlier_ = now().under_way.cpu_seconds;
      if (!now().state.position.empty()) simulation_->restore(std::move(now().state));
      now().state = {};
    }
    take_looks(plan_.rule, now().series, looks_);  // those of before the restart
    if (options_.resume == nullptr) take_frame();  // of a run without settling
    keep(good_.emplace());
  }

  /// Steps until the rule or the caller ends it. Throws Fault where the state is no longer one of this powder.
  void go_on() {
    constexpr std::uint64_t between_questions = 256;  // steps from one look at the clock and the caller to the next
    for (std::uint64_t steps = 0; !looks_.ended; ++steps) {
      simulation_->step();
      const bool ask = steps % between_questions == 0;
      if (ask && options_.stop.stop_requested()) result_.status = RunStatus::interrupted;
      take_frame();
      measure_step();
      if (ask) offer_checkpoint();
      if (result_.status == RunStatus::interrupted) break;
    }
    keep(*good_);
  }

  void fail(std::string reason) {
    result_.status = RunStatus::failed;
    result_.reason = std::move(reason);
  }

  /// The result of the run; of a failed run up to the last good state.
  RunResult finish() {
    if (good_) {
      now() = std::move(*good_);
      result_.diagnostics.steps = simulation_->state().step;
      result_.diagnostics.rebuilds = simulation_->state().rebuilds;
      result_.diagnostics.bytes_per_particle = simulation_->bytes_per_particle();
    }
    if (looks_.ended && looks_.next < now().series.time.size()) {  // a longer run is cut to what this case asks for
      cut(now().series, looks_.next, plan_.window);
      now().state = {};
    }
    result_.series = now().series;
    if (looks_.last.count == 0) looks_.last = measure(plan_.rule, now().series, now().series.time.size());
    result_.summary = summarise(case_, plan_.sample_time, sensor_.period, now().series, looks_);
    result_.summary.cpu_seconds = now().under_way.cpu_seconds;
    add_diagnostics();
    add_warnings();
    return std::move(result_);
  }

 private:
  Checkpoint& now() { return result_.checkpoint; }

  /// A state is large, so `now` goes without: only what is kept has one, in the memory of the one kept before.
  void keep(Checkpoint& kept) {
    now().under_way.cpu_seconds = cpu_earlier_ + cpu_time(options_.threads) - cpu_before_;
    kept = now();
    kept.state = simulation_->state();
  }

  void take_frame() {
    const std::uint64_t step = simulation_->state().step;
    while (next_frame_ < frames_.size() && frames_[next_frame_] < step) ++next_frame_;  // before a restart
    for (; next_frame_ < frames_.size() && frames_[next_frame_] == step; ++next_frame_)
      options_.frame(static_cast<int>(next_frame_), *simulation_,
                     static_cast<double>(frames_[next_frame_] - plan_.settle) * derived_.time_step);
  }

  /// Sums the step, and ends samples, windows and looks where they are due.
  void measure_step() {
    if (simulation_->state().step <= plan_.settle) return;
    const std::uint64_t turning = simulation_->state().step - plan_.settle;
    add_step(sampling_, *simulation_, now().under_way);
    if (turning % plan_.sample == 0) {
      take_sample(sampling_, *simulation_, turning, now());
      take_picture(sampling_, *simulation_, plan_, now());
      take_looks(plan_.rule, now().series, looks_);
    }
    if (turning % plan_.check == 0) {
      look_at_bed(*simulation_, box_, colour_, turning, now().series);
      keep(*good_);
      if (options_.progress) options_.progress(progress_of(now().series, plan_));
    }
  }

  void offer_checkpoint() {
    if (!options_.checkpoint) return;
    if (std::chrono::duration<double>(Clock::now() - saved_).count() <= options_.checkpoint_interval) return;
    Checkpoint here;
    keep(here);
    options_.checkpoint(here);
    saved_ = Clock::now();
  }

  void add_diagnostics() {
    Diagnostics& found = result_.diagnostics;
    found.deep_contacts = now().under_way.deep_contacts;
    found.max_overlap = now().under_way.max_overlap;
    found.simulated = now().series.time.empty() ? 0.0 : now().series.time.back();
    if (result_.summary.cpu_seconds > 0.0)
      found.steps_per_second =
          static_cast<double>(found.steps) * static_cast<double>(derived_.spheres) / result_.summary.cpu_seconds;
  }

  void add_warnings() {
    if (result_.status == RunStatus::done) result_.warnings = warnings_of(case_, result_.summary);
    if (result_.status == RunStatus::done && !now().series.torque.empty() && result_.summary.mean.front().mean == 0.0) {
      const std::vector<BodyLabel> labels = body_labels(case_);
      std::vector<std::string> names;
      for (const Driven& driven : sensor_.driven)
        names.push_back(driven.body < labels.size() ? labels[driven.body].name : "a body");
      result_.warnings.push_back(
          fmt::format("the torque is exactly 0: no sphere touched {}, or none with a lever about the axis",
                      fmt::join(names, ", ")));
    }
    if (result_.diagnostics.deep_contacts > 0)
      result_.warnings.push_back(fmt::format(
          "{} contact-steps overlap by more than {:g} of a radius, half of run.overlap_limit (largest {:.3g}): raise "
          "{}",
          result_.diagnostics.deep_contacts, 0.5 * case_.run.overlap_limit, result_.diagnostics.max_overlap,
          case_.contact.normal == NormalLaw::linear ? "contact.stiffness" : "contact.young_modulus"));
  }

  using Clock = std::chrono::steady_clock;
  const Case& case_;
  const Derived& derived_;
  const RunOptions& options_;
  BuiltRig rig_;  // until the simulation takes it
  Sensor sensor_;
  Box box_;
  Sampling sampling_;
  std::vector<std::uint8_t> colour_;
  Plan plan_;
  Looks looks_;
  std::vector<std::uint64_t> frames_;
  std::size_t next_frame_ = 0;
  std::optional<Simulation> simulation_;
  std::optional<Checkpoint> good_;
  RunResult result_;
  Clock::time_point saved_ = Clock::now();
  double cpu_before_ = 0.0, cpu_earlier_ = 0.0;  // s, of this process before, and of the run before it was resumed
};

}  // namespace

std::vector<std::uint64_t> frame_steps(const PreparedCase& prepared, int frames) {
  const Case& c = prepared.given();
  return frames_in(make_plan(c, prepared.derived(), turn_of(c)), frames);
}

bool long_enough(const PreparedCase& prepared, const Series& series) {
  const Case& c = prepared.given();
  const LookRule rule = make_plan(c, prepared.derived(), turn_of(c)).rule;
  Looks looks = begin_looks(rule);
  take_looks(rule, series, looks);
  return looks.ended;
}

RunResult run(const PreparedCase& prepared, std::uint64_t seed, const RunOptions& options) {
  Course course(prepared, seed, options);
  try {
    course.begin();
    course.go_on();
  } catch (const Fault& fault) {
    course.fail(fault.what());
  }
  return course.finish();
}

RunResult run(const Case& c, std::uint64_t seed, const RunOptions& options) { return run(prepare(c), seed, options); }

}  // namespace dem
