// Datasets of numbers and of texts (hdf5.hpp).
#include <algorithm>
#include <cassert>
#include <functional>
#include <numeric>

#include "data/hdf5.hpp"
#include "data/hdf5_handle.hpp"

namespace data {

using hdf5::silence, hdf5::space_of, hdf5::text_length, hdf5::text_type, hdf5::without_padding;

namespace {

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

std::vector<std::size_t> shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> extents(rank > 0 ? static_cast<std::size_t>(rank) : 0);
  if (rank > 0) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  return {extents.begin(), extents.end()};
}

std::size_t product(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

/// How many values a dataset has. Damaged extents ask for more than the file holds of them.
std::size_t elements(const Hdf5Group::Handle& group, const std::string& name, hid_t dataset,
                     const std::vector<std::size_t>& shape) {
  const Hdf5Id type(H5Dget_type(dataset), H5Tclose);
  const auto stored = static_cast<std::size_t>(H5Dget_storage_size(dataset));
  std::size_t bytes = H5Tget_size(type.get());
  for (const std::size_t extent : shape)
    if (__builtin_mul_overflow(bytes, extent, &bytes)) group.bad_data(name, "the dataset's extents are damaged");
  // What was never written reads as zeros, as other programs may leave it; more of it than this is no data.
  if (bytes > stored + (std::size_t{1} << 30))
    group.bad_data(name, "the dataset has larger extents than the file holds");
  return product(shape);
}

}  // namespace

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
  array.values.resize(elements(*handle_, name, found.get(), array.shape));
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
  const std::size_t count = elements(*handle_, name, found.get(), shape_of(space.get()));
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
