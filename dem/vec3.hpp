#pragma once
// Three-component vectors as plain data. Products are written out so that every build rounds them alike.
#include <cmath>

namespace dem {

struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
constexpr Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(Vec3 a) { return (1.0 / length(a)) * a; }

/// Rows of an orthogonal matrix: R a = (dot(x, a), dot(y, a), dot(z, a)).
struct Rotation {
  Vec3 x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};
};

constexpr Vec3 rotate(const Rotation& r, Vec3 a) { return {dot(r.x, a), dot(r.y, a), dot(r.z, a)}; }
/// The inverse rotation (transpose).
constexpr Vec3 rotate_back(const Rotation& r, Vec3 a) {
  return {r.x.x * a.x + r.y.x * a.y + r.z.x * a.z, r.x.y * a.x + r.y.y * a.y + r.z.y * a.z,
          r.x.z * a.x + r.y.z * a.y + r.z.z * a.z};
}

/// Rotation by `angle` [rad] about the unit vector `axis` (Rodrigues).
inline Rotation rotation_about(Vec3 axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), k = 1.0 - c;
  return {{c + k * axis.x * axis.x, k * axis.x * axis.y - s * axis.z, k * axis.x * axis.z + s * axis.y},
          {k * axis.y * axis.x + s * axis.z, c + k * axis.y * axis.y, k * axis.y * axis.z - s * axis.x},
          {k * axis.z * axis.x - s * axis.y, k * axis.z * axis.y + s * axis.x, c + k * axis.z * axis.z}};
}

}  // namespace dem
