#pragma once
// A small layer over the HDF5 C library: files, groups, attributes and datasets that close themselves. Numbers are
// stored as little-endian IEEE, creation order is tracked everywhere (netCDF-4 needs it), the library's own error
// output is silent, and every failure is an InputError that names the file and the object: 65 when reading, 73 when
// writing. Texts have a fixed length in the file: HDF5 1.10 crashes on damaged ones of variable length, so those are
// neither written nor read. A file that demcal wrote is read only as it was written (data/origin.hpp). Debian's serial
// library is built thread-safe, and any other is refused when compiling; two threads must still not share one of these
// objects.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace data {

/// A dataset's numbers, row by row, with its extents.
template <class T>
struct Array {
  std::vector<std::size_t> shape;
  std::vector<T> values;
};

/// A group (or the root) of an open file.
class Hdf5Group {
 public:
  Hdf5Group create_group(const std::string& name) const;
  Hdf5Group group(const std::string& name) const;
  bool has(const std::string& name) const;                ///< a group or dataset directly in this group
  std::vector<std::string> names() const;                 ///< names of the groups and datasets, in order of creation
  std::string place(const std::string& name = "") const;  ///< "training.h5: /columns/torque"

  // Attributes of this group, or, with a dataset's name, of that dataset.
  void set(const std::string& attribute, const std::string& text, const std::string& dataset = "") const;
  void set(const std::string& attribute, const char* text, const std::string& dataset = "") const;
  void set(const std::string& attribute, double value, const std::string& dataset = "") const;
  void set(const std::string& attribute, std::int64_t value, const std::string& dataset = "") const;
  void set(const std::string& attribute, const std::vector<std::int64_t>& values,
           const std::string& dataset = "") const;
  /// A fixed-length ASCII string, which VTKHDF asks for.
  void set_ascii(const std::string& attribute, const std::string& text) const;
  bool has_attribute(const std::string& attribute, const std::string& dataset = "") const;
  std::string text(const std::string& attribute, const std::string& dataset = "") const;
  double number(const std::string& attribute, const std::string& dataset = "") const;
  std::int64_t integer(const std::string& attribute, const std::string& dataset = "") const;

  /// Datasets of double, float, int64, uint64, int32 and uint8. An empty `shape` means one dimension. Numbers are
  /// converted to the type asked for when read.
  template <class T>
  void write(const std::string& name, std::span<const T> values, std::vector<std::size_t> shape = {}) const;
  template <class T>
  void write(const std::string& name, const std::vector<T>& values, std::vector<std::size_t> shape = {}) const {
    write(name, std::span<const T>(values), std::move(shape));
  }
  template <class T>
  Array<T> read(const std::string& name) const;
  void write_texts(const std::string& name, const std::vector<std::string>& values) const;  ///< UTF-8
  std::vector<std::string> read_texts(const std::string& name) const;

  /// Hands what was written so far to the system and reports what fails; call it before the last group goes.
  void flush() const;

  struct Handle;  ///< hdf5_handle.hpp
  explicit Hdf5Group(std::shared_ptr<Handle> handle) : handle_(std::move(handle)) {}

 private:
  std::shared_ptr<Handle> handle_;
};

/// Makes a file (combine with write_atomically). It closes with the last of its groups. Throws InputError (73).
Hdf5Group create_hdf5(const std::string& path);

/// Opens a file to read. Throws InputError: 66 missing; 65 not HDF5, truncated, or not as demcal wrote it.
Hdf5Group open_hdf5(const std::string& path);

/// Opens an existing file to add to it, and takes its mark of origin off. Throws as open_hdf5.
Hdf5Group open_hdf5_to_write(const std::string& path);

}  // namespace data
