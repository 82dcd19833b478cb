#pragma once
// Files that are either whole or not there: a temporary file beside the target, fsync, rename, fsync of the folder.
// A reader never sees half a file, and a crash leaves the old one.
#include <functional>
#include <string>
#include <string_view>

namespace data {

/// Writes `content` to `path`. Makes missing folders. Throws InputError (73) when it cannot.
void write_atomically(const std::string& path, std::string_view content);

/// The same for a file that `write` writes and closes under a temporary name (HDF5, netCDF). What `write` throws leaves
/// no file behind and is passed on.
void write_atomically(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// The whole of a file. Throws InputError: 66 when it is missing or cannot be read.
std::string read_file(const std::string& path);

/// How a path is named in messages: from the working folder when it lies inside it.
std::string shown_path(const std::string& path);

}  // namespace data
