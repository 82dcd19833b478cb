#pragma once
// The coefficients of the contact laws. One row says all of a coefficient but what a law makes of it (dem/bed/bed.cpp).
// By the rows studies are read, targets are bound, and settings are written and checked.
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "dem/case/case.hpp"

namespace dem {

/// Whether a coefficient above 0 brings a force that is not there without it: then some law must read it.
enum class Brings { no_force, a_force };

struct Coefficient {
  const char* key;         ///< key in [contact]
  const char* unit;        ///< SI
  double low, high;        ///< SI, values that a simulation can take
  const char* meaning;     ///< one line
  double Contact::*field;  ///< the coefficient; or, of one with a field `own`, what it follows while that is not set
  std::optional<double> Contact::*own = nullptr;
  std::string (*unread)(const Contact& k) = nullptr;  ///< why the laws chosen do not read it, or ""; null: all read it
  Brings brings = Brings::no_force;

  double value(const Contact& k) const { return own != nullptr ? (k.*own).value_or(k.*field) : k.*field; }
  /// The value that is given; 0 for a coefficient that follows another while it is not set.
  double given(const Contact& k) const { return own != nullptr ? (k.*own).value_or(0.0) : k.*field; }
  void set(Contact& k, double si) const {
    if (own != nullptr)
      k.*own = si;
    else
      k.*field = si;
  }
};

/// All coefficients, in the order in which settings_text writes them; what is new comes last.
std::span<const Coefficient> coefficients();

/// How many of them stand before bed and rig in settings_text. The text was first written so, and runs are known by it.
inline constexpr std::size_t first_coefficients = 11;

/// Why the laws chosen do not read a coefficient; empty where they do. Throws std::out_of_range where none has this
/// key.
std::string unread(const Contact& k, std::string_view key);

/// The coefficients that a pair of materials may have of its own, by key.
struct PairKey {
  std::string_view key;
  std::optional<double> PairContact::*field;
};
inline constexpr PairKey pair_keys[]{{"stiffness", &PairContact::stiffness},
                                     {"restitution", &PairContact::restitution},
                                     {"friction", &PairContact::friction},
                                     {"rolling_friction", &PairContact::rolling_friction},
                                     {"twisting_friction", &PairContact::twisting_friction},
                                     {"hamaker", &PairContact::hamaker},
                                     {"work_of_adhesion", &PairContact::work_of_adhesion}};

}  // namespace dem
