#include "dem/stl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>

#include "data/atomic_file.hpp"
#include "data/error.hpp"

namespace dem {
namespace {

constexpr std::size_t head_size = 84, row_size = 50;

[[noreturn]] void fail(const std::string& place, std::string what, std::string remedy) {
  throw data::InputError(data::ExitStatus::bad_data, data::Problem{place, std::move(what), std::move(remedy)});
}

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
        fail(
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
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
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
      fail(place(), fmt::format("has a coordinate '{}' that is not finite", word), "export the mesh again");
    return value;
  }
  Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  [[noreturn]] void stop(std::string_view word, const std::string& where) const {
    if (word.empty()) fail(place(), "ends " + where + ": the file is truncated", "export the mesh again");
    fail(place(), fmt::format("has '{}' {}", word.substr(0, 40), where), "export the mesh as STL again");
  }

  static bool same(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
      return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
    });
  }

 private:
  static bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

TriangleMesh parse_ascii(std::string_view bytes, const std::string& name, double unit) {
  TriangleMesh mesh;
  Words words(bytes, name);
  // Several solids may follow each other; their names, which may hold anything, end with the line.
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!Words::same(word, "solid")) words.stop(word, "where 'solid' belongs");
    words.skip_line();
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
    }
    if (!Words::same(word, "endsolid")) words.stop(word, "where 'facet' or 'endsolid' belongs");
    words.skip_line();
  }
  return mesh;
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& name, double unit) {
  const std::size_t binary_size = head_size + row_size * static_cast<std::size_t>(binary_count(bytes));
  const bool binary = bytes.size() >= head_size && bytes.size() == binary_size;
  std::string_view start = bytes.substr(0, 512);
  const bool text = std::none_of(start.begin(), start.end(), [](unsigned char c) { return c == 0 || c >= 0xf8; });
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (bytes.empty()) fail(name, "is empty", "export the mesh again");
  if (!binary && !(text && Words::same(start.substr(0, 5), "solid"))) {
    if (text || bytes.size() < head_size) {
      fail(name, "is not STL: it neither begins with 'solid' nor has the size of a binary file",
           "export the mesh as STL");
    }
    fail(name,
         fmt::format("has {} bytes, but its {} triangles make {}: {}", bytes.size(), binary_count(bytes), binary_size,
                     bytes.size() < binary_size ? "it is truncated, or not STL" : "it is not STL"),
         "export the mesh as STL again");
  }
  TriangleMesh mesh = binary ? parse_binary(bytes, name, unit) : parse_ascii(bytes, name, unit);
  if (mesh.triangles.empty()) fail(name, "holds no triangle", "export the mesh again");
  return mesh;
}

TriangleMesh read_stl(const std::string& path, double unit) {
  return parse_stl(data::read_file(path), data::shown_path(path), unit);
}

void write_stl(const TriangleMesh& mesh, const std::string& path) {
  std::string bytes(head_size, '\0');
  constexpr std::string_view title = "demcal, metres";
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
