#pragma once
// What the files of hdf5.hpp share: identifiers that close themselves, and the helpers of groups and their attributes.
#include <fmt/format.h>
#include <hdf5.h>

#include <string_view>

#include "data/error.hpp"
#include "data/hdf5.hpp"

namespace data {

/// An HDF5 identifier and what closes it.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  bool ok() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

namespace hdf5 {

/// The library prints its error stack per thread unless told not to.
inline void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// UTF-8 of `length` bytes, filled up with zeros.
Hdf5Id text_type(std::size_t length);
/// Reads as many bytes as the stored text has; anything else than text of fixed length has none.
std::size_t text_length(hid_t stored);
std::string without_padding(std::string_view text);

/// The extents of an attribute or dataset; without any it is one value.
Hdf5Id space_of(const std::vector<std::size_t>& shape);

}  // namespace hdf5

struct Hdf5Group::Handle {
  std::shared_ptr<Hdf5Id> file;  ///< keeps the file open as long as any group
  Hdf5Id id;
  std::string path;    ///< path of the file
  std::string inside;  ///< "/columns"

  std::string place(const std::string& name) const {
    if (inside == "/" && name.empty()) return path;
    return fmt::format("{}: {}{}{}", path, inside, inside == "/" || name.empty() ? "" : "/", name);
  }
  [[noreturn]] void bad_data(const std::string& name, const std::string& what) const {
    throw InputError(ExitStatus::bad_data,
                     Problem{place(name), what, "the file is damaged or of another kind: make it again"});
  }
  [[noreturn]] void cannot_write(const std::string& name) const {
    throw InputError(ExitStatus::cannot_write,
                     Problem{place(name), "cannot be written", "check the room and rights there"});
  }
  /// The object that carries an attribute: this group or a dataset of it.
  Hdf5Id carrier(const std::string& dataset) const;
  void set(const std::pair<std::string, std::string>& attribute_of, hid_t file_type, const Hdf5Id& space,
           const std::pair<hid_t, const void*>& memory) const;
  /// Reads a one-element attribute of the given class into `memory`.
  void get(const std::pair<std::string, std::string>& attribute_of, H5T_class_t expected,
           const std::pair<hid_t, void*>& memory) const;
};

}  // namespace data
