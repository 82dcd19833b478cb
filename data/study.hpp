#pragma once
// What a study says about parameters, controls, outputs, observations and cases. The DEM's sections are read by
// dem/reading/read_case.cpp: [rig], [contact], [run], and what [materials.*] holds beside `fixed` and `runs`.
// All numbers are SI; a Unit beside them is for display only.
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/axis.hpp"
#include "data/study_file.hpp"
#include "data/unit.hpp"

namespace data {

enum class PriorKind { uniform, log_uniform, normal, truncated_normal, log_normal, beta, posterior };

template <>
inline constexpr std::array texts_of<PriorKind> = {"uniform",    "log_uniform", "normal",   "truncated_normal",
                                                   "log_normal", "beta",        "posterior"};

/// The prior density of one parameter. It is zero outside [low, high], which lies within the parameter's range, as a
/// surrogate knows nothing beyond.
///   kind              fields read                                        support
///   uniform           -                                                  [low, high]
///   log_uniform       -                                                  [low, high], uniform in the logarithm
///   normal            mean, sd                                           the parameter's range
///   truncated_normal  mean, sd                                           [low, high]
///   log_normal        mean: the median; sd of the logarithm              the parameter's range
///   beta              alpha, beta                                        [low, high]
///   posterior         posterior_of, cut                                  that of the other case
struct Prior {
  PriorKind kind = PriorKind::uniform;
  double low = 0.0;   ///< SI; by default the parameter's range
  double high = 1.0;  ///< SI
  double mean = 0.0;  ///< SI
  double sd = 0.0;    ///< SI (log_normal: of the logarithm)
  double alpha = 1.0;
  double beta = 1.0;
  std::string posterior_of;  ///< name of a case, kind posterior
  bool cut = false;          ///< kind posterior: taken without feedback, the case's data do not change it
  std::string place;
  bool stated = true;  ///< false: the study says nothing, and uniform is assumed
};

/// A quantity to be calibrated.
struct Parameter {
  std::string name;
  std::string target;  ///< what it sets in the DEM ("contact.friction"); by default the name
  Unit unit;
  double low = 0.0;   ///< SI, range of training and default prior
  double high = 1.0;  ///< SI
  Scale scale = Scale::linear;
  Prior prior;
  std::string place;
  Axis axis() const { return {low, high, scale}; }
};

/// A standard error: the root of the sum of the squares of its two parts.
struct Spread {
  double absolute = 0.0;  ///< SI
  double relative = 0.0;  ///< share of the value
  bool some() const { return absolute > 0.0 || relative > 0.0; }
  bool operator==(const Spread&) const = default;
};

/// How the error of a control enters a case.
enum class SettingErrorAs {
  covariance,  ///< first order, in the covariance; set anew at each value of the control
  shared,      ///< in the covariance, but one error of all points, whatever their values: a tachometer's
  unknown      ///< sampled as an unknown
};

template <>
inline constexpr std::array texts_of<SettingErrorAs> = {"covariance", "shared", "unknown"};

/// How well a control is known. Points of a set at one value of the control (a fill, repeats at a speed) share its
/// error.
struct SettingError {
  std::size_t control = 0;  ///< index into Study::controls
  Spread spread;
  SettingErrorAs as = SettingErrorAs::covariance;
  std::string place;
};

/// A quantity that the experiment sets (rpm).
struct Control {
  std::string name;
  std::string target;
  Unit unit;
  double low = 0.0;   ///< SI
  double high = 1.0;  ///< SI
  Scale scale = Scale::linear;
  std::optional<SettingError> uncertainty;  ///< error in every observation set that does not state its own
  std::string place;
  Axis axis() const { return {low, high, scale}; }
};

struct Output {
  std::string name;
  Unit unit;
  std::string place;
};

/// A material's own rows of the training table. A study without [materials] has one, named "".
struct Material {
  std::string name;
  std::map<std::string, double> fixed;  ///< parameters its training runs do not vary, SI
  std::optional<int> runs;              ///< number of runs, instead of [training] runs
  std::string powder;                   ///< materials of one powder are its levels of coarse graining; may be empty
  std::string place;
};

/// What makes the study's runs.
enum class Engine {
  demcal,
  none,  ///< another code: the study brings its table
};

template <>
inline constexpr std::array texts_of<Engine> = {"demcal", "none"};

struct Training {
  int runs = 64;                 ///< per material
  double standard_error = 0.02;  ///< wanted relative standard error of the first output
  std::string table;             ///< file of rows that come with the study, absolute path; empty if none
  std::string low;               ///< rows of a cheaper level of the model under the table's, absolute path; or empty
  std::vector<std::string> leave_out;  ///< rows not to learn from: "31" (a line of the table) or "training.csv:31"
  Engine engine = Engine::demcal;
  std::string place;
};

/// One measured point: outputs at given controls. Some outputs may not have been measured there.
struct Observation {
  std::vector<double> controls;         ///< SI, in the order of Study::controls
  std::vector<double> values;           ///< SI, in the order of ObservationSet::outputs; NaN: not measured
  std::vector<double> standard_errors;  ///< SI; NaN where the value is
  int line = 0;

  /// Whether the output of this column (an index into ObservationSet::outputs) was measured.
  bool has(std::size_t column) const { return !std::isnan(values[column]); }
};

/// A row of an observation file that copies another row to the last digit (data/copies.hpp); it is counted once.
struct ObservationCopy {
  int line = 0, of = 0;
};

/// Readings of one setting that agree far better than their errors say (data/repeats.hpp): they were averaged.
struct SharedErrors {
  std::size_t output = 0;                  ///< index into Study::outputs
  std::size_t readings = 0, settings = 0;  ///< readings with a partner, and the settings at which they were made
  double scatter = 0.0;                    ///< scatter over that which the errors state
};

/// An error of the measurement that all points of a set share (a calibration, a mounting).
struct CommonError {
  std::size_t output = 0;  ///< index into Study::outputs
  Spread spread;
  bool apart = false;  ///< apart from its meter's: integrated out by itself, where the meter reads nothing else
};

/// A correlation of the errors of two outputs read at one setting, such as two numbers read off one picture.
struct ErrorCorrelation {
  std::size_t output = 0, other_output = 0;  ///< indices into Study::outputs
  std::string other_set = {};                ///< set that holds the other output's readings
  double value = 0.0;                        ///< correlation coefficient
  std::string place = {};
};

struct ObservationSet {
  std::string name;
  std::string material;
  std::string file;                  ///< absolute path
  std::vector<std::size_t> outputs;  ///< indices into Study::outputs, of the columns that the file has
  std::vector<Observation> points;   ///< without copies; the means of readings that share their error
  std::vector<ObservationCopy> copies = {};
  std::vector<SharedErrors> repeats = {};
  std::vector<std::size_t> empty_outputs = {};      ///< indices into Study::outputs, of columns without any value
  std::vector<std::string> parameter_columns = {};  ///< names of the study's parameters of which the file has columns
  std::vector<std::string> unread = {};  ///< columns of numbers that vary and are neither read nor of demcal observe
  std::string meter = {};  ///< sets that name one meter share its common errors; empty: each set has its own
  std::vector<CommonError> common_errors;
  std::vector<ErrorCorrelation> correlations = {};
  std::vector<SettingError> setting_errors;
  std::string read_with = {};       ///< name of a set at whose settings these points were read; empty: at their own
  bool of_machine = false;          ///< measured on the whole machine, of which the runs simulate a slice
  bool assumed = false;             ///< stands for a measurement before any is made (uq/plan/unmeasured.hpp)
  std::vector<std::string> header;  ///< the comment lines at the head of the file, without '#'
  std::string place;

  /// Where an output (an index into Study::outputs) stands among the set's; nothing where it has none.
  std::optional<std::size_t> column_of(std::size_t output) const;
};

/// An unknown of a measurement beside the parameters, and how it acts on the model's prediction m of what is read:
enum class NuisanceKind {
  offset,          ///< added to every reading of an output: an idle torque
  gain,            ///< multiplies every reading of an output
  noise_scale,     ///< multiplies the stated standard errors
  noise_sd,        ///< stands in the place of the standard errors, the same at all points
  scale,           ///< ratio of the machine's reading to the slice's
  setting,         ///< a control's true value in one observation set
  discrepancy_sd,  ///< of a Gaussian process over the controls: share of the root mean square of the measured values
  discrepancy_length,  ///< its correlation length, in ranges of the controls
};

struct Nuisance {
  NuisanceKind kind = NuisanceKind::offset;
  std::optional<std::size_t> output;  ///< index into Study::outputs of the output it acts on; none: all of the case
  Parameter parameter;                ///< name, unit, range and prior
};

enum class Sampler { mixture, nuts };

template <>
inline constexpr std::array texts_of<Sampler> = {"mixture", "nuts"};

/// A calibration case: which parameters are free given which observations.
struct CalibrationCase {
  std::string name;
  std::vector<std::string> observe;  ///< names of observation sets; none: nothing is measured yet
  std::string material;              ///< material whose runs a case that observes nothing is planned on
  std::vector<std::string> free;
  std::map<std::string, double> fixed;  ///< SI
  std::map<std::string, double> held;   ///< SI: free parameters held at these values in a second case, to compare
  std::map<std::string, Prior> priors;  ///< priors that replace the parameters' own
  std::vector<Nuisance> nuisances;
  Sampler sampler = Sampler::mixture;
  std::string place;
};

/// Observation sets that a case does not use, to be compared with what the case predicts of them.
struct UnusedData {
  std::string name;
  std::size_t case_index = 0;  ///< into Study::cases
  std::vector<std::string> observe;
  std::string place;
};

/// Ratio of the machine's torque to the slice's: a number, or unknown with a prior.
struct RigScale {
  double value = 1.0;
  std::optional<Nuisance> unknown;
};

struct Study {
  std::string name;
  std::string description;
  std::vector<std::string> notes;  ///< choices that the source does not give; the report shows them beside the verdicts
  std::uint64_t seed = 1;
  std::string file;    ///< absolute path of study.toml
  std::string folder;  ///< the folder that holds study.toml
  std::vector<Parameter> parameters;
  std::vector<Control> controls;
  std::vector<Output> outputs;
  std::vector<Material> materials;
  Training training;
  std::optional<RigScale> scale;  ///< [rig] scale
  std::vector<ObservationSet> observations;
  std::vector<CalibrationCase> cases;
  std::vector<UnusedData> unused_data;

  std::optional<std::size_t> parameter_index(std::string_view parameter_name) const;
  std::optional<std::size_t> control_index(std::string_view control_name) const;
  std::optional<std::size_t> observation_index(std::string_view set_name) const;
  std::optional<std::size_t> case_index(std::string_view case_name) const;
  const Material& material(std::string_view material_name) const;
};

/// A parameter or a control as an input of a run. It refers to the study.
struct Input {
  const std::string& name;
  const std::string& target;
  const Unit& unit;
  Axis axis;
};

/// The inputs of a run, in the order of RunRow::inputs: parameters, then controls.
std::vector<Input> inputs_of(const Study& study);

/// Reads the sections above and the observation files. Problems are recorded in `file` (file.finish() throws them) so
/// that the DEM's sections can be read in the same pass. Missing or malformed observation files throw InputError with
/// all that was found so far: 66 or 65, or 78 when the study has problems of its own.
Study read_study(const StudyFile& file);

/// Throws InputError (78) when the study has no observations or no cases, or a case observes nothing. Training and a
/// plan on the prior need none of them, calibration does.
void require_cases(const Study& study);

/// Observed points whose controls lie outside the controls' ranges, where a surrogate extrapolates.
std::vector<Problem> outside_training_range(const Study& study);

}  // namespace data
