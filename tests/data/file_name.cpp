#include "data/file_name.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

TEST_CASE("a name made of any text lies in its folder, is no option, and means nothing to a shell") {
  std::set<std::string> names;
  const std::vector<std::string> texts{"../../../EVIL",
                                       "/etc/passwd",
                                       "..",
                                       ".",
                                       "",
                                       "-e",
                                       "a b",
                                       "O'Brien",
                                       "a\nb",
                                       "\x1b]0;x\x07",
                                       "$(touch x)",
                                       "`id`",
                                       "a;b",
                                       "<pipe",
                                       "Mischer \xc3\x9f 2",
                                       "con\xff",
                                       std::string(300, 'a'),
                                       "a/b",
                                       "a\\b"};
  for (const std::string& text : texts) {
    const std::string name = data::file_name(text);
    INFO(name);
    CHECK(data::is_file_name(name));
    CHECK(std::filesystem::path("out") / name == std::filesystem::path("out/" + name).lexically_normal());
    CHECK(names.insert(name).second);  // different texts, different names
  }
  for (const std::string plain : {"zirconia-800", "a_b.c", "0", "_x"}) CHECK(data::file_name(plain) == plain);
}

TEST_CASE("a word of a command line is quoted where a shell would take it apart") {
  CHECK(data::shell_word("my-mixer/x.toml") == "my-mixer/x.toml");
  CHECK(data::shell_word("a b") == "'a b'");
  CHECK(data::shell_word("O'Brien") == "'O'\\''Brien'");
  CHECK(data::shell_word("-x") == "'-x'");
  CHECK(data::shell_word("") == "''");
}
