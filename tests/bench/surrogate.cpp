// One fit and one prediction of a table of runs, timed in CPU seconds of this process (driver:
// tests/bench/surrogate.py).
//   bench_surrogate TRAIN.csv TEST.csv [--lengths l1,l2,... --signal SD --nugget SD]
// The process is what the peers fit: ARD Matern 5/2 and nugget, zero mean of the centred output, maximum likelihood,
// one start. With hyper-parameters given, only their log evidence is printed, so that every program is judged by one
// likelihood.
#include <fmt/core.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "surrogate/fit.hpp"

namespace {

/// Rows of numbers; the last column of a training file is the output.
Eigen::MatrixXd read_csv(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::vector<double> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    if (!row.empty()) rows.push_back(row);
  }
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.at(0).size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows[i].size(); ++k) result(i, k) = rows[i][k];
  return result;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// MiB, the most that this program ever had resident (getrusage counts the program that started it, too).
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  return 0.0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments, arguments + count);
  const Eigen::MatrixXd table = read_csv(words.at(1)), points = read_csv(words.at(2));
  const Eigen::Index d = table.cols() - 1;
  const double centre = table.col(d).mean();
  const surrogate::TrainingSet training{table.leftCols(d), table.col(d).array() - centre, {}};

  if (count > 3) {
    surrogate::HyperParameters hyper;
    hyper.length_scales.resize(d);
    std::stringstream lengths(words.at(4));
    for (Eigen::Index k = 0; k < d; ++k) {
      std::string cell;
      std::getline(lengths, cell, ',');
      hyper.length_scales[k] = std::stod(cell);
    }
    hyper.signal_sd = std::stod(words.at(6));
    hyper.nugget_sd = std::stod(words.at(8));
    fmt::print("{{\"evidence\": {:.10g}}}\n",
               surrogate::condition(training, {.mean = surrogate::MeanBasis::zero}, hyper).log_marginal_likelihood());
    return 0;
  }
  const surrogate::FitOptions options{
      .mean = surrogate::MeanBasis::zero, .starts = 1, .estimate = surrogate::Estimate::maximum_likelihood};
  // Repeated until it has taken half a second, at least three times unless that is long; the best counts, as for the
  // peers.
  double fit_seconds = 1e9, predict_seconds = 1e9, spent = 0.0;
  int repeats = 0;
  for (; repeats < 1 || (repeats < 3 && spent < 20.0) || (spent < 0.5 && repeats < 200); ++repeats) {
    const double start = cpu_seconds();
    const surrogate::GaussianProcess process = surrogate::fit(training, options);
    const double seconds = cpu_seconds() - start;
    fit_seconds = std::min(fit_seconds, seconds);
    spent += seconds;
  }
  const double fit_memory = peak_memory();
  const surrogate::GaussianProcess process = surrogate::fit(training, options);
  surrogate::MarginalPrediction prediction;
  for (int i = 0; i < 5; ++i) {
    const double start = cpu_seconds();
    prediction = process.predict_marginal(points);
    predict_seconds = std::min(predict_seconds, cpu_seconds() - start);
  }
  fmt::print(
      "{{\"fit_s\": {:.6g}, \"predict_s\": {:.6g}, \"memory_mb\": {:.4g}, \"evidence\": {:.10g}, \"evaluations\": {}, "
      "\"nugget_factor\": {:.17g}, \"mean\": [",
      fit_seconds, predict_seconds, fit_memory, process.log_marginal_likelihood(),
      process.diagnostics().starts.front().evaluations,
      std::pow(process.hyper_parameters().nugget_sd / process.hyper_parameters().signal_sd, 2));
  for (Eigen::Index i = 0; i < points.rows(); ++i) fmt::print("{}{:.17g}", i ? ", " : "", prediction.mean[i] + centre);
  fmt::print("]}}\n");
}
