#include "dem/walls/stl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/origin.hpp"

namespace dem {
namespace {

constexpr std::size_t head_size = 84, row_size = 50;

void add_triangle(TriangleMesh& mesh, const std::array<Vec3, 3>& corner) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corner.begin(), corner.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

bool finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

std::uint32_t binary_count(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= head_size) std::memcpy(&count, bytes.data() + head_size - sizeof count, sizeof count);
  return count;
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& name, double unit) {
  TriangleMesh mesh;
  for (std::size_t t = 0; t < binary_count(bytes); ++t) {
    std::array<float, 12> row{};  // the normal, then three corners
    std::memcpy(row.data(), bytes.data() + head_size + t * row_size, sizeof row);
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = unit * Vec3{row[3 + 3 * k], row[4 + 3 * k], row[5 + 3 * k]};
      if (!finite(corner[k])) {
        data::refuse_data(
            fmt::format("{}: triangle {}", name, t + 1),
            fmt::format("has a corner ({}, {}, {}) that is not finite", row[3 + 3 * k], row[4 + 3 * k], row[5 + 3 * k]),
            "export the mesh again");
      }
    }
    add_triangle(mesh, corner);
  }
  return mesh;
}

/// Words of a text with the line they stand on.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// The next word; empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) {
      const bool end = text_[at_] == '\n' || (text_[at_] == '\r' && text_.substr(at_ + 1, 1) != "\n");
      ++at_;
      line_ += end ? 1 : 0;
    }
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }
  /// Behind "solid" or "endsolid": passes the name, up to the line's end or, in a file of one line, up to `keyword` and
  /// the word that always follows it.
  void skip_name(std::string_view keyword, std::string_view follows) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    Words ahead = *this;
    while (ahead.at_ < end) {
      const Words here = ahead;
      if (!same(ahead.next(), keyword)) continue;
      Words behind = ahead;
      if (!follows.empty() && !same(behind.next(), follows)) continue;
      *this = here;
      return;
    }
    at_ = end;
  }
  /// Whether nothing is left but blanks and what some programs pad with.
  bool only_padding() const {
    return std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(),
                       [](char c) { return is_blank(c) || c == '\0' || c == '\x1a'; });
  }
  std::string place() const { return fmt::format("{}:{}", name_, line_); }

  void expect(std::string_view keyword) {
    const std::string_view word = next();
    if (!same(word, keyword)) stop(word, fmt::format("where '{}' belongs", keyword));
  }
  double number() {
    std::string_view word = next();
    if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || end != word.data() + word.size() ||
        (error != std::errc{} && error != std::errc::result_out_of_range)) {
      stop(word, "where a coordinate belongs");
    }
    if (!std::isfinite(value) || error != std::errc{})
      data::refuse_data(place(), fmt::format("has a coordinate '{}' that is not finite", word),
                        "export the mesh again");
    return value;
  }
  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  [[noreturn]] void stop(std::string_view word, const std::string& where) const {
    if (word.empty()) data::refuse_data(place(), "ends " + where + ": the file is truncated", "export the mesh again");
    data::refuse_data(place(), fmt::format("has '{}' {}", word.substr(0, 40), where), "export the mesh as STL again");
  }

  static bool same(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
      return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    });
  }

 private:
  static bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

TriangleMesh parse_ascii(std::string_view bytes, const std::string& name, double unit) {
  TriangleMesh mesh;
  Words words(bytes, name);
  // Several solids may follow each other; their names, which may hold anything, end with the line.
  while (!words.only_padding()) {
    std::string_view word = words.next();
    if (!Words::same(word, "solid")) words.stop(word, "where 'solid' belongs");
    words.skip_name("facet", "normal");
    for (word = words.next(); Words::same(word, "facet"); word = words.next()) {
      words.expect("normal");
      for (int k = 0; k < 3; ++k) words.next();  // not used, and some programs write nan
      words.expect("outer");
      words.expect("loop");
      std::array<Vec3, 3> corner;
      for (Vec3& c : corner) {
        words.expect("vertex");
        c = unit * words.vector();
      }
      words.expect("endloop");
      words.expect("endfacet");
      add_triangle(mesh, corner);
      if (words.only_padding()) return mesh;  // without "endsolid"
    }
    if (!Words::same(word, "endsolid")) words.stop(word, "where 'facet' or 'endsolid' belongs");
    words.skip_name("solid", "");
  }
  return mesh;
}

/// Whether the triangles of a binary file with bytes behind them are what they seem: their normals have length 1 or 0.
bool normals_are_sound(std::string_view bytes) {
  const std::size_t count = binary_count(bytes);
  std::size_t sound = 0;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 3> normal{};
    std::memcpy(normal.data(), bytes.data() + head_size + t * row_size, sizeof normal);
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    sound += length == 0.0 || std::abs(length - 1.0) < 0.01 ? 1 : 0;
  }
  return count > 0 && 10 * sound >= 9 * count;
}

/// Single precision has 24 bits: far from the origin they are used up by the distance.
void check_distance(const TriangleMesh& mesh, const std::string& name, double unit) {
  Vec3 low = mesh.vertices.front(), high = low;
  double far = 0.0;
  for (const Vec3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    far = std::max({far, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z}), step = std::ldexp(far, -23);
  if (step > 1e-3 * size)
    data::refuse_data(
        name,
        fmt::format("lies {:.4g} from its origin and is {:.4g} large: single precision there has steps of {:.2g}",
                    far / unit, size / unit, step / unit),
        "move the part to the origin and export it again");
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& name, double unit) {
  const std::size_t binary_size = head_size + row_size * static_cast<std::size_t>(binary_count(bytes));
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff"))
    data::refuse_data(name, "is UTF-16, and STL is ASCII or binary", "export the mesh as STL again");
  std::string_view start = bytes.substr(0, 512);
  const bool text = start.find('\0') == std::string_view::npos;
  const bool binary = bytes.size() >= head_size && (bytes.size() == binary_size ||
                                                    (bytes.size() > binary_size && !text && normals_are_sound(bytes)));
  if (text && start.starts_with("\xef\xbb\xbf")) {
    start.remove_prefix(3);
    bytes.remove_prefix(3);
  }
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (bytes.empty()) data::refuse_data(name, "is empty", "export the mesh again");
  if (!binary && !(text && Words::same(start.substr(0, 5), "solid"))) {
    if (text || bytes.size() < head_size) {
      data::refuse_data(name, "is not STL: it neither begins with 'solid' nor has the size of a binary file",
                        "export the mesh as STL");
    }
    data::refuse_data(
        name,
        fmt::format("has {} bytes, but its {} triangles make {}: {}", bytes.size(), binary_count(bytes), binary_size,
                    bytes.size() < binary_size ? "it is truncated, or not STL" : "it is not STL"),
        "export the mesh as STL again");
  }
  TriangleMesh mesh = binary ? parse_binary(bytes, name, unit) : parse_ascii(bytes, name, unit);
  if (mesh.triangles.empty()) data::refuse_data(name, "holds no triangle", "export the mesh again");
  if (binary) check_distance(mesh, name, unit);
  return mesh;
}

TriangleMesh read_stl(const std::string& path, double unit) {
  return parse_stl(data::read_file(path), data::shown_path(path), unit);
}

void write_stl(const TriangleMesh& mesh, const std::string& path) {
  std::string bytes(head_size, '\0');
  const std::string title = "demcal, metres; " + data::blank_mark();
  static_assert(head_size - sizeof(std::uint32_t) >= 75);
  std::copy(title.begin(), title.end(), bytes.begin());
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(bytes.data() + head_size - sizeof count, &count, sizeof count);
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    std::array<float, 12> row{};
    std::size_t k = 0;
    for (const Vec3 v : {unit(cross(b - a, c - a)), a, b, c}) {
      for (const double x : {v.x, v.y, v.z}) row[k++] = static_cast<float>(x);
    }
    bytes.append(reinterpret_cast<const char*>(row.data()), sizeof row);
    bytes.append(2, '\0');  // the attribute
  }
  data::write_atomically(path, bytes);
}

}  // namespace dem
