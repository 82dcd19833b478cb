#include "data/hdf5.hpp"

#include <algorithm>
#include <cassert>

#include "data/atomic_file.hpp"
#include "data/hdf5_handle.hpp"
#include "data/origin.hpp"

#ifndef H5_HAVE_THREADSAFE
#error "this HDF5 is not thread-safe, and runs write files at the same time: take the serial one of libhdf5-dev"
#endif

namespace data {

namespace hdf5 {

Hdf5Id text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(1, length));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return Hdf5Id(type, H5Tclose);
}

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

}  // namespace hdf5

using hdf5::silence, hdf5::space_of, hdf5::text_length, hdf5::text_type, hdf5::without_padding;

Hdf5Id Hdf5Group::Handle::carrier(const std::string& dataset) const {
  return Hdf5Id(dataset.empty() ? H5Oopen(id.get(), ".", H5P_DEFAULT) : H5Oopen(id.get(), dataset.c_str(), H5P_DEFAULT),
                H5Oclose);
}

void Hdf5Group::Handle::set(const std::pair<std::string, std::string>& attribute_of, hid_t file_type,
                            const Hdf5Id& space, const std::pair<hid_t, const void*>& memory) const {
  silence();
  const auto& [attribute, dataset] = attribute_of;
  const Hdf5Id object = carrier(dataset);
  if (object.ok() && H5Aexists(object.get(), attribute.c_str()) > 0) H5Adelete(object.get(), attribute.c_str());
  const Hdf5Id made(H5Acreate2(object.get(), attribute.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  if (!made.ok() || H5Awrite(made.get(), memory.first, memory.second) < 0) cannot_write(dataset + "@" + attribute);
}

void Hdf5Group::Handle::get(const std::pair<std::string, std::string>& attribute_of, H5T_class_t expected,
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

namespace {

/// When a file cannot be closed, say because the disk is full, the library's clean-up at the program's end crashes. All
/// files are closed here, so there is nothing left to clean up. It must be told before its first use.
[[maybe_unused]] const bool no_clean_up = H5dont_atexit() >= 0;

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

}  // namespace data
