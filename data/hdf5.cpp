#include "data/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <numeric>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/origin.hpp"

#ifndef H5_HAVE_THREADSAFE
#error "this HDF5 is not thread-safe, and runs write files at the same time: take the serial one of libhdf5-dev"
#endif

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

namespace {

/// When a file cannot be closed, say because the disk is full, the library's clean-up at the program's end crashes. All
/// files are closed here, so there is nothing left to clean up. It must be told before its first use.
[[maybe_unused]] const bool no_clean_up = H5dont_atexit() >= 0;

/// The library prints its error stack per thread unless told not to.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

template <class T>
struct Types;
template <>
struct Types<double> {
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static hid_t file() { return H5T_IEEE_F64LE; }
};
template <>
struct Types<float> {
  static hid_t memory() { return H5T_NATIVE_FLOAT; }
  static hid_t file() { return H5T_IEEE_F32LE; }
};
template <>
struct Types<std::int64_t> {
  static hid_t memory() { return H5T_NATIVE_INT64; }
  static hid_t file() { return H5T_STD_I64LE; }
};
template <>
struct Types<std::uint64_t> {
  static hid_t memory() { return H5T_NATIVE_UINT64; }
  static hid_t file() { return H5T_STD_U64LE; }
};
template <>
struct Types<std::int32_t> {
  static hid_t memory() { return H5T_NATIVE_INT32; }
  static hid_t file() { return H5T_STD_I32LE; }
};
template <>
struct Types<std::uint8_t> {
  static hid_t memory() { return H5T_NATIVE_UINT8; }
  static hid_t file() { return H5T_STD_U8LE; }
};

/// UTF-8 of `length` bytes, filled up with zeros.
Hdf5Id text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(1, length));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return Hdf5Id(type, H5Tclose);
}

/// Reads as many bytes as the stored text has; anything else than text of fixed length has none.
std::size_t text_length(hid_t stored) {
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) != 0) return 0;
  return H5Tget_size(stored);
}

std::string without_padding(std::string_view text) { return std::string(text.substr(0, text.find('\0'))); }

Hdf5Id space_of(const std::vector<std::size_t>& shape) {
  if (shape.empty()) return Hdf5Id(H5Screate(H5S_SCALAR), H5Sclose);
  std::vector<hsize_t> extents(shape.begin(), shape.end());
  return Hdf5Id(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose);
}

std::vector<std::size_t> shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> extents(rank > 0 ? static_cast<std::size_t>(rank) : 0);
  if (rank > 0) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  return {extents.begin(), extents.end()};
}

std::size_t product(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

}  // namespace

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
  /// How many values a dataset has. Damaged extents ask for more than the file holds of them.
  std::size_t elements(const std::string& name, hid_t dataset, const std::vector<std::size_t>& shape) const {
    const Hdf5Id type(H5Dget_type(dataset), H5Tclose);
    const auto stored = static_cast<std::size_t>(H5Dget_storage_size(dataset));
    std::size_t bytes = H5Tget_size(type.get());
    for (const std::size_t extent : shape)
      if (__builtin_mul_overflow(bytes, extent, &bytes)) bad_data(name, "the dataset's extents are damaged");
    // What was never written reads as zeros, as other programs may leave it; more of it than this is no data.
    if (bytes > stored + (std::size_t{1} << 30)) bad_data(name, "the dataset has larger extents than the file holds");
    return product(shape);
  }
  /// The object that carries an attribute: this group or a dataset of it.
  Hdf5Id carrier(const std::string& dataset) const {
    return Hdf5Id(
        dataset.empty() ? H5Oopen(id.get(), ".", H5P_DEFAULT) : H5Oopen(id.get(), dataset.c_str(), H5P_DEFAULT),
        H5Oclose);
  }
  void set(const std::pair<std::string, std::string>& attribute_of, hid_t file_type, const Hdf5Id& space,
           const std::pair<hid_t, const void*>& memory) const {
    silence();
    const auto& [attribute, dataset] = attribute_of;
    const Hdf5Id object = carrier(dataset);
    if (object.ok() && H5Aexists(object.get(), attribute.c_str()) > 0) H5Adelete(object.get(), attribute.c_str());
    const Hdf5Id made(H5Acreate2(object.get(), attribute.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose);
    if (!made.ok() || H5Awrite(made.get(), memory.first, memory.second) < 0) cannot_write(dataset + "@" + attribute);
  }
  /// Reads a one-element attribute of the given class into `memory`.
  void get(const std::pair<std::string, std::string>& attribute_of, H5T_class_t expected,
           const std::pair<hid_t, void*>& memory) const {
    silence();
    const auto& [attribute, dataset] = attribute_of;
    const Hdf5Id object = carrier(dataset);
    const Hdf5Id found(H5Aopen(object.get(), attribute.c_str(), H5P_DEFAULT), H5Aclose);
    if (!found.ok()) bad_data(dataset + "@" + attribute, "the attribute is missing");
    const Hdf5Id type(H5Aget_type(found.get()), H5Tclose);
    const Hdf5Id space(H5Aget_space(found.get()), H5Sclose);
    if (H5Tget_class(type.get()) != expected || H5Sget_simple_extent_npoints(space.get()) != 1 ||
        H5Aread(found.get(), memory.first, memory.second) < 0) {
      bad_data(dataset + "@" + attribute, "the attribute is not of the expected type");
    }
  }
};

namespace {

std::shared_ptr<Hdf5Group::Handle> open_root(hid_t file, const std::string& path) {
  auto held = std::make_shared<Hdf5Id>(file, H5Fclose);
  const hid_t root = H5Gopen2(file, "/", H5P_DEFAULT);
  return std::shared_ptr<Hdf5Group::Handle>(new Hdf5Group::Handle{held, Hdf5Id(root, H5Gclose), path, "/"});
}

Hdf5Group open_file(const std::string& path, unsigned mode) {
  silence();
  require_file(path);
  if (H5Fis_hdf5(path.c_str()) <= 0) {
    throw InputError(ExitStatus::bad_data,
                     Problem{shown_path(path), "is not an HDF5 file, or its beginning is damaged", "make it again"});
  }
  if (mode != H5F_ACC_RDONLY) remove_mark(path);
  require_unchanged(path, "make it again");
  const hid_t file = H5Fopen(path.c_str(), mode, H5P_DEFAULT);
  if (file < 0) {
    throw InputError(ExitStatus::bad_data,
                     Problem{shown_path(path), "is a truncated or damaged HDF5 file", "make it again"});
  }
  return Hdf5Group(open_root(file, shown_path(path)));
}

}  // namespace

Hdf5Group create_hdf5(const std::string& path) {
  silence();
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), H5P_DEFAULT);
  if (file < 0) {
    throw InputError(ExitStatus::cannot_write,
                     Problem{path, "cannot be written", "check the folder, its room and rights"});
  }
  return Hdf5Group(open_root(file, path));
}

Hdf5Group open_hdf5(const std::string& path) { return open_file(path, H5F_ACC_RDONLY); }
Hdf5Group open_hdf5_to_write(const std::string& path) { return open_file(path, H5F_ACC_RDWR); }

void Hdf5Group::flush() const {
  silence();
  if (H5Fflush(handle_->id.get(), H5F_SCOPE_GLOBAL) < 0) handle_->cannot_write("");
}

std::string Hdf5Group::place(const std::string& name) const { return handle_->place(name); }

Hdf5Group Hdf5Group::create_group(const std::string& name) const {
  silence();
  const Hdf5Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const hid_t made = H5Gcreate2(handle_->id.get(), name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT);
  if (made < 0) handle_->cannot_write(name);
  const std::string inside = handle_->inside == "/" ? "/" + name : handle_->inside + "/" + name;
  return Hdf5Group(std::shared_ptr<Handle>(new Handle{handle_->file, Hdf5Id(made, H5Gclose), handle_->path, inside}));
}

Hdf5Group Hdf5Group::group(const std::string& name) const {
  silence();
  const hid_t found = H5Gopen2(handle_->id.get(), name.c_str(), H5P_DEFAULT);
  if (found < 0) handle_->bad_data(name, "the group is missing");
  const std::string inside = handle_->inside == "/" ? "/" + name : handle_->inside + "/" + name;
  return Hdf5Group(std::shared_ptr<Handle>(new Handle{handle_->file, Hdf5Id(found, H5Gclose), handle_->path, inside}));
}

bool Hdf5Group::has(const std::string& name) const {
  silence();
  return H5Lexists(handle_->id.get(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5Group::names() const {
  silence();
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  if (H5Literate(handle_->id.get(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, add, &names) < 0) {
    names.clear();  // a file of another program may not track the order
    H5Literate(handle_->id.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
  }
  return names;
}

void Hdf5Group::set(const std::string& attribute, const std::string& text, const std::string& dataset) const {
  const Hdf5Id type = text_type(text.size());
  handle_->set({attribute, dataset}, type.get(), space_of({}), {type.get(), text.c_str()});
}

void Hdf5Group::set(const std::string& attribute, const char* text, const std::string& dataset) const {
  set(attribute, std::string(text), dataset);
}

void Hdf5Group::set(const std::string& attribute, double value, const std::string& dataset) const {
  handle_->set({attribute, dataset}, H5T_IEEE_F64LE, space_of({}), {H5T_NATIVE_DOUBLE, &value});
}

void Hdf5Group::set(const std::string& attribute, std::int64_t value, const std::string& dataset) const {
  handle_->set({attribute, dataset}, H5T_STD_I64LE, space_of({}), {H5T_NATIVE_INT64, &value});
}

void Hdf5Group::set(const std::string& attribute, const std::vector<std::int64_t>& values,
                    const std::string& dataset) const {
  handle_->set({attribute, dataset}, H5T_STD_I64LE, space_of({values.size()}), {H5T_NATIVE_INT64, values.data()});
}

void Hdf5Group::set_ascii(const std::string& attribute, const std::string& text) const {
  assert(!text.empty());
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), text.size());
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  handle_->set({attribute, ""}, type.get(), space_of({}), {type.get(), text.data()});
}

bool Hdf5Group::has_attribute(const std::string& attribute, const std::string& dataset) const {
  silence();
  const Hdf5Id object = handle_->carrier(dataset);
  return object.ok() && H5Aexists(object.get(), attribute.c_str()) > 0;
}

std::string Hdf5Group::text(const std::string& attribute, const std::string& dataset) const {
  silence();
  const Hdf5Id object = handle_->carrier(dataset);
  const Hdf5Id found(H5Aopen(object.get(), attribute.c_str(), H5P_DEFAULT), H5Aclose);
  if (!found.ok()) handle_->bad_data(dataset + "@" + attribute, "the attribute is missing");
  const Hdf5Id stored(H5Aget_type(found.get()), H5Tclose);
  const std::size_t length = text_length(stored.get());
  if (length == 0 || length > H5Aget_storage_size(found.get()))
    handle_->bad_data(dataset + "@" + attribute, "the attribute is not text of fixed length");
  std::string text(length, '\0');
  handle_->get({attribute, dataset}, H5T_STRING, {stored.get(), text.data()});
  return without_padding(text);
}

double Hdf5Group::number(const std::string& attribute, const std::string& dataset) const {
  double value = 0.0;
  handle_->get({attribute, dataset}, H5T_FLOAT, {H5T_NATIVE_DOUBLE, &value});
  return value;
}

std::int64_t Hdf5Group::integer(const std::string& attribute, const std::string& dataset) const {
  std::int64_t value = 0;
  handle_->get({attribute, dataset}, H5T_INTEGER, {H5T_NATIVE_INT64, &value});
  return value;
}

template <class T>
void Hdf5Group::write(const std::string& name, std::span<const T> values, std::vector<std::size_t> shape) const {
  silence();
  if (shape.empty()) shape = {values.size()};
  assert(product(shape) == values.size());
  const Hdf5Id space = space_of(shape);
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_attr_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const Hdf5Id made(H5Dcreate2(handle_->id.get(), name.c_str(), Types<T>::file(), space.get(), H5P_DEFAULT,
                               creation.get(), H5P_DEFAULT),
                    H5Dclose);
  if (!made.ok() ||
      (!values.empty() && H5Dwrite(made.get(), Types<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)) {
    handle_->cannot_write(name);
  }
}

template <class T>
Array<T> Hdf5Group::read(const std::string& name) const {
  silence();
  const Hdf5Id found(H5Dopen2(handle_->id.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!found.ok()) handle_->bad_data(name, "the dataset is missing");
  const Hdf5Id type(H5Dget_type(found.get()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  const Hdf5Id space(H5Dget_space(found.get()), H5Sclose);
  Array<T> array;
  array.shape = shape_of(space.get());
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) handle_->bad_data(name, "the dataset does not hold numbers");
  array.values.resize(handle_->elements(name, found.get(), array.shape));
  if (!array.values.empty() &&
      H5Dread(found.get(), Types<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) < 0) {
    handle_->bad_data(name, "the dataset cannot be read");
  }
  return array;
}

#define DEMCAL_INSTANTIATE(T)                                                                                \
  template void Hdf5Group::write<T>(const std::string&, std::span<const T>, std::vector<std::size_t>) const; \
  template Array<T> Hdf5Group::read<T>(const std::string&) const;
DEMCAL_INSTANTIATE(double)
DEMCAL_INSTANTIATE(float)
DEMCAL_INSTANTIATE(std::int64_t)
DEMCAL_INSTANTIATE(std::uint64_t)
DEMCAL_INSTANTIATE(std::int32_t)
DEMCAL_INSTANTIATE(std::uint8_t)
#undef DEMCAL_INSTANTIATE

void Hdf5Group::write_texts(const std::string& name, const std::vector<std::string>& values) const {
  silence();
  std::size_t length = 1;
  for (const std::string& value : values) length = std::max(length, value.size());
  std::string bytes(values.size() * length, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(bytes.data() + i * length, length);
  const Hdf5Id type = text_type(length);
  const Hdf5Id space = space_of({values.size()});
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_attr_creation_order(creation.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  const Hdf5Id made(
      H5Dcreate2(handle_->id.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
  if (!made.ok() ||
      (!values.empty() && H5Dwrite(made.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)) {
    handle_->cannot_write(name);
  }
}

std::vector<std::string> Hdf5Group::read_texts(const std::string& name) const {
  silence();
  const Hdf5Id found(H5Dopen2(handle_->id.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!found.ok()) handle_->bad_data(name, "the dataset is missing");
  const Hdf5Id stored(H5Dget_type(found.get()), H5Tclose);
  const std::size_t length = text_length(stored.get());
  if (length == 0) handle_->bad_data(name, "the dataset does not hold texts of fixed length");
  const Hdf5Id space(H5Dget_space(found.get()), H5Sclose);
  const std::size_t count = handle_->elements(name, found.get(), shape_of(space.get()));
  std::string bytes(count * length, '\0');
  if (count > 0 && H5Dread(found.get(), stored.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) {
    handle_->bad_data(name, "the dataset cannot be read");
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(without_padding(std::string_view(bytes).substr(i * length, length)));
  return values;
}

}  // namespace data
