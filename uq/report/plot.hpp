#pragma once
// Common parts of the report's figures: blocks of data, axis scales, the look. Used by figure*.cpp.
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace uq::plot {

// Okabe & Ito (2008), "Color universal design".
inline constexpr const char* blue = "#0072B2";
inline constexpr const char* sky = "#56B4E9";
inline constexpr const char* pale = "#CFE6F5";  ///< sky, lightened: fills
inline constexpr const char* vermillion = "#D55E00";
inline constexpr const char* green = "#009E73";
inline constexpr const char* ink = "#222222";
inline constexpr const char* grey = "#777777";
/// The colours of curves that stand side by side.
inline constexpr std::array colours = {blue, vermillion, green, sky, ink, grey};

/// An axis: the power of ten (a multiple of three) taken out of its numbers, and its label that says so.
struct Axis {
  double scale = 1.0;  ///< numbers in the script are data times this
  std::string label;
};
Axis axis_for(std::string_view name, std::string_view unit, double largest);

/// A block of data: "# name", the columns row by row, two blank lines. Rows with a NaN or an infinity are left out.
std::string block(std::string_view name, const std::vector<std::vector<double>>& columns);

/// Grid, borders and fonts, the same in every figure; the key above the plot, where it hides no data.
std::string common_style();

/// set xlabel / ylabel (`which` is x or y).
std::string label(char which, const Axis& axis);

struct Extent {
  double low = 0.0, high = 1.0;
  bool empty = true;
  void include(double value);
  /// The extent widened on both sides by a share of its width, or, where it is a point, by a share of its value.
  Extent padded(double share) const;
  double largest() const;
};

}  // namespace uq::plot
