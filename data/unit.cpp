// Units by UDUNITS-2. Its parser gives a unit; a visitor takes it apart into si = scale (value + origin) and a product
// of base units, which is the dimension. Logarithmic units and time stamps have no such form and are refused.
#include "data/unit.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>

#include "data/error.hpp"

namespace data {
namespace {

struct Parsed {
  double scale = 1.0;
  double origin = 0.0;
  std::map<std::string, int> powers;  ///< powers of the base units: the dimension
};

ut_status visit_basic(const ut_unit* unit, void* out) {
  static_cast<Parsed*>(out)->powers[ut_get_symbol(unit, UT_ASCII)] = 1;
  return UT_SUCCESS;
}

ut_status visit_product(const ut_unit*, int count, const ut_unit* const* basic, const int* powers, void* out) {
  for (int i = 0; i < count; ++i) {
    if (powers[i] != 0) static_cast<Parsed*>(out)->powers[ut_get_symbol(basic[i], UT_ASCII)] = powers[i];
  }
  return UT_SUCCESS;
}

ut_status refuse_timestamp(const ut_unit*, const ut_unit*, double, void*) { return UT_MEANINGLESS; }
ut_status refuse_logarithmic(const ut_unit*, double, const ut_unit*, void*) { return UT_MEANINGLESS; }

ut_status visit_galilean(const ut_unit*, double scale, const ut_unit* underlying, double origin, void* out) {
  auto* parsed = static_cast<Parsed*>(out);
  parsed->scale = scale;
  parsed->origin = origin;
  const ut_visitor inner{visit_basic, visit_product, visit_galilean, refuse_timestamp, refuse_logarithmic};
  return ut_accept_visitor(underlying, &inner, out);
}

/// UDUNITS-2 keeps global state: one thread at a time.
Parsed parse(std::string_view symbol) {
  ut_status found{};
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    return ut_read_xml(nullptr);
  }();
  if (system == nullptr)
    throw InputError(ExitStatus::missing_program,
                     Problem{std::string(ut_get_path_xml(nullptr, &found)), "UDUNITS-2 cannot read its table of units",
                             "install libudunits2-0, or check that the file can be read and that there is memory"});

  std::string text(symbol);
  // UDUNITS' scanner prints what it does not know, a line's end say, to stdout.
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  ut_trim(text.data(), UT_UTF8);
  const std::unique_ptr<ut_unit, decltype(&ut_free)> unit(ut_parse(system, text.c_str(), UT_UTF8), &ut_free);
  if (unit == nullptr && ut_get_status() == UT_OS) throw std::bad_alloc();
  Parsed parsed;
  const ut_visitor visitor{visit_basic, visit_product, visit_galilean, refuse_timestamp, refuse_logarithmic};
  if (unit == nullptr || ut_accept_visitor(unit.get(), &visitor, &parsed) != UT_SUCCESS) {
    throw std::invalid_argument(fmt::format("'{}' is not a unit that UDUNITS-2 knows", symbol));
  }
  return parsed;
}

std::string base_units(const std::map<std::string, int>& powers) {
  std::string text;
  for (const bool positive : {true, false}) {
    for (const auto& [base, power] : powers) {
      if ((power > 0) != positive) continue;
      if (!text.empty()) text += ' ';
      text += power == 1 ? base : fmt::format("{}{}", base, power);
    }
  }
  return text.empty() ? "1" : text;
}

}  // namespace

Unit parse_unit(std::string_view symbol) {
  const Parsed parsed = parse(symbol);
  return {.symbol = std::string(symbol),
          .factor = parsed.scale,
          .offset = parsed.scale * parsed.origin,
          .si_symbol = base_units(parsed.powers)};
}

bool convertible(std::string_view a, std::string_view b) { return parse(a).powers == parse(b).powers; }

double Unit::rounded(double si, int digits) const { return to_si(fmt::format("{:.{}g}", from_si(si), digits)); }

double Unit::to_si(std::string_view text) const {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  long double value = 0.0L;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return static_cast<double>(static_cast<long double>(factor) * value + static_cast<long double>(offset));
}

std::string Unit::digits(double si) const {
  const long double value =
      (static_cast<long double>(si) - static_cast<long double>(offset)) / static_cast<long double>(factor);
  std::string text;
  for (int count = 1; count <= 21; ++count) {
    text = fmt::format("{:.{}g}", value, count);
    if (to_si(text) == si) break;
  }
  // "300", not "3e+02", where no digit is made up for it.
  const std::string plain = fmt::format("{:.15g}", value);
  return plain.size() <= text.size() && to_si(plain) == si ? plain : text;
}

}  // namespace data
