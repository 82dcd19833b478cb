#pragma once
// Files that are either whole or not there: a temporary file beside the target, fsync, rename, fsync of the folder.
// A reader never sees half a file, and a crash leaves the old one. What demcal did not write itself is never replaced:
// data/origin.hpp tells, and every file written here carries its mark of origin.
#include <functional>
#include <string>
#include <string_view>

namespace data {

/// What to do with a file of demcal's at the target that was changed since it was written.
enum class Changed {
  replace,  ///< it is damaged, and made again
  refuse,   ///< it may have been edited by hand
};

/// Writes `content` to `path`, with the mark of origin where the file's kind has a place for it. Makes missing folders.
/// Throws InputError (73) when it cannot, or when the file that is there is not demcal's to replace.
void write_atomically(const std::string& path, std::string_view content, Changed changed = Changed::replace);

/// Has `write` write and close a file (HDF5, netCDF) under a temporary name, and puts it in the place of `path` as
/// above. What `write` throws leaves no file behind and is passed on, with `path` for the temporary name in its
/// messages.
void write_atomically(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// Writes a file as it is, without the guarantee of a whole file and without a mark: for use within the `write` above,
/// under its temporary name. Throws InputError (73).
void write_bytes(const std::string& path, std::string_view bytes);

/// Throws as write_atomically would where the file that is there must not be replaced.
void require_replaceable(const std::string& path, Changed changed = Changed::replace);

/// The whole of a file. Throws InputError: 66 when it is missing, is no file (a folder, a pipe, a device) or cannot be
/// read.
std::string read_file(const std::string& path);

/// Throws as read_file does where the path holds no file that can be read.
void require_file(const std::string& path);

/// The path as messages name it: relative to the working folder when it lies inside that folder.
std::string shown_path(const std::string& path);

}  // namespace data
