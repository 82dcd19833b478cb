#pragma once
// Output to the terminal. Texts of files, names and keys among them, are data: a control character in one is shown as
// its code and does nothing. A terminal that is closed, a full disk behind a redirection or a reader that left cannot
// stop the job.
#include <string>
#include <string_view>

namespace data {

/// `text` with every control character but the line end and the tab, every byte that is not UTF-8, and every character
/// that turns the direction of writing shown as its code: "\x1b", "\u202e".
std::string printable(std::string_view text);

/// Writes a line for the user on standard error, made printable. What cannot be written is lost without a word.
void tell(std::string_view line);

/// Writes the result on standard output, a line. Throws InputError (73) when it cannot be written.
void print_result(std::string_view text);

/// Writes what a person asked for on standard output, a line, made printable. A reader that left and a stream that is
/// closed are no failures, as the same is kept in files; a full disk is one: throws InputError (73).
void print_answer(std::string_view text);

/// Whether the two streams end in different places, so that a line on one is not seen beside the other's.
bool answers_go_elsewhere();

/// Guards the standard streams; call it at the program's start. Streams that are closed are held by something harmless,
/// so that no file takes their place. A reader that leaves (SIGPIPE) or a limit on a file's size (SIGXFSZ) becomes an
/// error and does not end the program.
void guard_streams();

}  // namespace data
