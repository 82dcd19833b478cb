#pragma once
// Memory that the system does not give ends the program at once, with words and the status of bad data (65). Nothing is
// unwound: Eigen 3.4 keeps the pointer of what it freed when an array cannot grow, and its destructor would free it
// again. Nothing is lost by that, as files are whole or not there, and temporary ones are removed by the next process.
// The link sends malloc and realloc of this program's own objects here (cli/CMakeLists.txt); `new` comes by its
// handler.

namespace cli {

/// Sets the handlers; call it before the first thread.
void guard_memory();

/// Says that memory has run out, and ends the program.
[[noreturn]] void out_of_memory();

}  // namespace cli
