#include "cli/out_of_memory.hpp"

#include <unistd.h>

#include <cstddef>
#include <new>
#include <string_view>

#include "data/error.hpp"

namespace cli {

void guard_memory() { std::set_new_handler(out_of_memory); }

void out_of_memory() {
  constexpr std::string_view words =
      "this needs more memory than the system gives (use fewer rows, spheres or a smaller box, fewer --jobs, or a "
      "larger machine; what was finished is kept)\n";
  static_cast<void>(::write(STDERR_FILENO, words.data(), words.size()) < 0);  // nowhere else to say it
  ::_exit(static_cast<int>(data::ExitStatus::bad_data));
}

}  // namespace cli

// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_realloc(void* old, std::size_t size);
void* __wrap_malloc(std::size_t size);
void* __wrap_realloc(void* old, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  void* const place = __real_malloc(size);
  if (place == nullptr && size > 0) cli::out_of_memory();
  return place;
}

void* __wrap_realloc(void* old, std::size_t size) {
  void* const place = __real_realloc(old, size);
  if (place == nullptr && size > 0) cli::out_of_memory();
  return place;
}
}
// NOLINTEND(bugprone-reserved-identifier)
