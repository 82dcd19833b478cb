#include "data/terminal.hpp"

#include <catch2/catch.hpp>

TEST_CASE("control characters of a text are shown and do nothing, and other characters stay") {
  CHECK(data::printable("plain, \xc2\xb5N\xc2\xb7m, \xe6\xbc\xa2\n\ttab") ==
        "plain, \xc2\xb5N\xc2\xb7m, \xe6\xbc\xa2\n\ttab");
  CHECK(data::printable("\x1b]0;title\x07") == "\\x1b]0;title\\x07");
  CHECK(data::printable("a\rb\x7f\b") == "a\\x0db\\x7f\\x08");
  CHECK(data::printable("\xc2\x9b"
                        "2J") == "\\u009b2J");  // CSI of C1
  CHECK(data::printable("\xe2\x80\xae"
                        "gpj.exe") == "\\u202egpj.exe");  // right to left
  CHECK(data::printable("R\xfchrwerk \xc0\x80 \xed\xa0\x80") == "R\\xfchrwerk \\xc0\\x80 \\xed\\xa0\\x80");
}
