#pragma once
// A lock that lets one process at a time do a job in a results folder. It is the kernel's lock on a file (flock), so it
// goes with its holder however the holder ends. The file says who holds it.
#include <string>

namespace data {

/// Holds FOLDER/.NAME.lock while it lives. Makes the folder. Throws InputError: 73 when another process holds the lock
/// (its number, machine and what it does are told), or when the folder cannot be written.
class FolderLock {
 public:
  FolderLock(const std::string& folder, const std::string& name, const std::string& doing);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  std::string path_;
  int file_ = -1;
};

/// This machine's name, as locks and temporary files carry it.
std::string machine_name();

}  // namespace data
