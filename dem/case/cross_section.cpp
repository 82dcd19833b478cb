#include "dem/case/cross_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dem {
namespace {

using std::numbers::pi;

double trough_below(double radius, double z) {
  return z <= 0.0 ? disc_below(radius, z) : 0.5 * pi * radius * radius + 2.0 * radius * z;
}

/// Areas of shaft and blade below z.
double shaft_below(const Rig& rig, double z) { return disc_below(rig.shaft_radius, z); }
double blade_below(const Rig& rig, double z) {
  return rig.blade_thickness / rig.pitch * (disc_below(rig.blade_radius, z) - disc_below(rig.shaft_radius, z));
}

}  // namespace

double disc_below(double radius, double z) {
  if (z <= -radius) return 0.0;
  if (z >= radius) return pi * radius * radius;
  return radius * radius * std::acos(-z / radius) + z * std::sqrt(radius * radius - z * z);
}

double trough_room_below(const Rig& rig, double z) {
  return trough_below(rig.trough_radius, z) - shaft_below(rig, z) - blade_below(rig, z);
}

double end_gap(const Rig& rig) { return 2.0 * rig.clearance() + 0.5 * rig.blade_thickness; }

double machine_room_below(const Rig& rig, double z) {
  const Machine& m = rig.machine.value();
  const double r = rig.trough_radius;
  double room = 2.0 * (m.length * (trough_below(r, z) - shaft_below(rig, z)) -
                       (m.length - m.opening - end_gap(rig)) * blade_below(rig, z));
  // Above the sill the openings are wider than two troughs by what the partition takes elsewhere: its thickness, and
  // below the axes what the two half circles leave between them.
  if (z > m.sill) {
    const double low = std::min(m.sill, 0.0), high = std::min(z, 0.0);
    double between = m.partition * (z - m.sill);
    between += 2.0 * r * (high - low) - (disc_below(r, high) - disc_below(r, low));
    room += 2.0 * m.opening * between;
  }
  // Powder above the partition lies on it as well.
  if (z > m.partition_height) room += (m.length - 2.0 * m.opening) * m.partition * (z - m.partition_height);
  return room;
}

TroughFill level_out(const Rig& rig, double bed, const std::function<double(double z)>& room_below) {
  double low = -rig.trough_radius, high = rig.blade_radius;
  TroughFill fill{bed / room_below(high), 0.0};
  while (room_below(high) < bed) {
    low = high;
    high += rig.trough_radius + (high + rig.trough_radius);
  }
  for (int k = 0; k < 80; ++k) {
    const double middle = 0.5 * (low + high);
    (room_below(middle) < bed ? low : high) = middle;
  }
  fill.surface = high;
  return fill;
}

double level_volume(const Rig& rig) {
  if (rig.drum) return rig.drum->volume();
  return rig.machine ? machine_room_below(rig, rig.blade_radius) : 0.0;
}

}  // namespace dem
