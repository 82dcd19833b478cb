#pragma once
// Three-component vectors as plain data, of numbers or of lanes (dem/contact/lanes.hpp). Products are written out so
// that every build rounds them alike.
#include <cmath>
#include <type_traits>

namespace dem {

template <class T>
struct Vector3 {
  T x{}, y{}, z{};
};
using Vec3 = Vector3<double>;

template <class T>
constexpr Vector3<T> operator+(Vector3<T> a, Vector3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vector3<T> operator-(Vector3<T> a, Vector3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vector3<T> operator-(Vector3<T> a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
constexpr Vector3<T> operator*(std::type_identity_t<T> s, Vector3<T> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
constexpr Vector3<T>& operator+=(Vector3<T>& a, Vector3<T> b) {
  return a = a + b;
}
template <class T>
constexpr Vector3<T>& operator-=(Vector3<T>& a, Vector3<T> b) {
  return a = a - b;
}
template <class T>
constexpr T dot(Vector3<T> a, Vector3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vector3<T> cross(Vector3<T> a, Vector3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(Vec3 a) { return (1.0 / length(a)) * a; }

/// Rows of an orthogonal matrix: R a = (dot(x, a), dot(y, a), dot(z, a)).
struct Rotation {
  Vec3 x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};
};

template <class T>
constexpr Vector3<T> rotate(const Rotation& r, Vector3<T> a) {
  return {r.x.x * a.x + r.x.y * a.y + r.x.z * a.z, r.y.x * a.x + r.y.y * a.y + r.y.z * a.z,
          r.z.x * a.x + r.z.y * a.y + r.z.z * a.z};
}
/// The inverse rotation (transpose).
template <class T>
constexpr Vector3<T> rotate_back(const Rotation& r, Vector3<T> a) {
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
