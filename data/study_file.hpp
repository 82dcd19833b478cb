#pragma once
// A study.toml in which every key that is asked for counts as used, and every key that nobody asked for is an
// error with its line. Readers (data/study.cpp, dem/reading/read_case.cpp) ask; problems are collected, not thrown, so
// that one pass reports them all.
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data/error.hpp"
#include "data/texts.hpp"
#include "data/unit.hpp"

namespace data {

/// Closed or open interval that a value must lie in, in the unit that is read.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  bool open_high = false;
};
inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0.0, .open_low = true};
inline constexpr Range non_negative{.low = 0.0};

/// What stands behind a key.
enum class ValueKind { missing, number, text, flag, table, other };

/// What a reader said of a key when it asked for it.
struct AskedKey {
  std::string type;  ///< "number", "whole number", "quantity", "text", "choice", "true or false", "list of ...",
                     ///< "table", "tables"
  std::string unit;  ///< SI, of a quantity
  Range range = {};
  std::string fallback;              ///< SI; empty: none
  std::vector<std::string> choices;  ///< of a choice
};

class StudyFile;

/// One table of the study. A missing table reads as an empty one. Every getter marks its key as used; when the value
/// is missing without fallback, of the wrong type, unit or range, a Problem is recorded and the fallback (or the
/// bound nearest to sense, or empty text) is returned so that reading goes on.
class Section {
 public:
  bool exists() const;                                 ///< whether the table is in the file
  bool has(std::string_view key) const;                ///< whether the key is there; makes the key known, but not used
  ValueKind kind(std::string_view key) const;          ///< kind of the key's value; makes the key known, but not used
  std::string place(std::string_view key = "") const;  ///< "study.toml:12: contact.friction"
  std::string name() const;                            ///< dotted: "parameters.friction"

  double number(std::string_view key, Range range, std::optional<double> fallback = {}) const;
  std::int64_t integer(std::string_view key, Range range, std::optional<std::int64_t> fallback = {}) const;
  /// "800 um" -> SI value of the dimension of `si_unit` ("m"); bounds and fallback in SI. A bare number is an error
  /// unless `default_unit` is given (a section with a `unit`), or the dimension is none ("1").
  double quantity(std::string_view key, std::string_view si_unit, Range range, std::optional<double> fallback = {},
                  const Unit* default_unit = nullptr) const;
  /// Reads an error, a shift or another difference in the same way: "2 degC" are 2 K. `quantity` too reads its value so
  /// where its `default_unit` is of differences.
  /// `default_unit` is of differences.
  double difference(std::string_view key, std::string_view si_unit, Range range, std::optional<double> fallback = {},
                    const Unit* default_unit = nullptr) const;
  std::string text(std::string_view key, const std::optional<std::string>& fallback = {}) const;
  /// One of `options`; anything else is an error that lists them.
  std::string choice(std::string_view key, const std::vector<std::string>& options,
                     const std::optional<std::string>& fallback = {}) const;
  /// One of an enum's values, by its texts.
  template <HasTexts Enum>
  Enum choice(std::string_view key, Enum fallback) const {
    const std::vector<std::string> options(texts_of<Enum>.begin(), texts_of<Enum>.end());
    return from_text<Enum>(choice(key, options, to_text(fallback))).value_or(fallback);
  }
  bool flag(std::string_view key, bool fallback) const;
  std::vector<std::string> texts(std::string_view key, bool required = false) const;
  /// A list of texts or whole numbers, as texts: [31, "runs.csv:44"].
  std::vector<std::string> labels(std::string_view key) const;
  std::vector<double> quantities(std::string_view key, std::string_view si_unit, Range range,
                                 const Unit* default_unit = nullptr) const;

  Section child(std::string_view key) const;                      ///< sub-table (also inline), empty if missing
  std::vector<std::pair<std::string, Section>> children() const;  ///< named sub-tables in file order
  std::vector<Section> array(std::string_view key) const;         ///< [[key]] tables in file order

  /// Takes these keys as used: what they mean hangs on one that is faulty, which is the problem.
  void pass_over(const std::vector<std::string>& keys) const;
  /// Records a problem at `key` of this table.
  void problem(std::string_view key, std::string what, std::string remedy) const;

  struct Node;  ///< in study_node.hpp
  explicit Section(std::shared_ptr<Node> node) : node_(std::move(node)) {}

 private:
  std::shared_ptr<Node> node_;
};

/// The whole file. `overrides` are "dotted.key=VALUE" texts (--set), applied before anything is read; VALUE is a
/// TOML value, or, when it does not parse as one, text.
class StudyFile {
 public:
  /// `path`: the file, or a folder that holds study.toml. Throws InputError: 66 missing, 78 syntax (file, line,
  /// column).
  static StudyFile open(const std::string& path, const std::vector<std::string>& overrides = {});

  Section root() const;
  std::string path() const;    ///< path of the file
  std::string folder() const;  ///< folder of the file; relative paths in the study start here

  /// Every key that was asked for so far, whether it is there or not, by its dotted name. A test compares the reference
  /// of keys (study_keys.hpp) with this list.
  const std::map<std::string, AskedKey>& asked() const;
  /// Every key that is read only when it is there, and was looked for.
  const std::set<std::string>& looked_for() const;

  /// The problems recorded so far, in the order of the file.
  std::vector<Problem> recorded() const;

  /// Throws InputError (78) with every problem recorded so far and, for each key that nobody asked for, its line and
  /// the nearest known key of the same table.
  void finish() const;

  struct State;  ///< in study_node.hpp
 private:
  std::shared_ptr<State> state_;
};

}  // namespace data
