#include "data/text_encoding.hpp"

#include <catch2/catch.hpp>

#include "tests/temporary.hpp"

namespace {

std::string utf16(const std::u16string& text, bool big) {
  std::string bytes;
  for (const char16_t c : text) {
    const char low = static_cast<char>(c & 0xff), high = static_cast<char>(c >> 8);
    bytes += big ? std::string{high, low} : std::string{low, high};
  }
  return bytes;
}

}  // namespace

TEST_CASE("the encodings of spreadsheets and instruments give the same text, and say what they were") {
  const std::u16string wide = u"time,torque [\u00b5N\u00b7m]\n1,2\n\U0001F600\n";
  const std::string expected = "time,torque [\xc2\xb5N\xc2\xb7m]\n1,2\n\xf0\x9f\x98\x80\n";
  for (const bool big : {false, true}) {
    const std::string mark = big ? "\xfe\xff" : "\xff\xfe";
    for (const std::string& front : {mark, std::string()}) {
      const data::DecodedText decoded = data::decode_text(front + utf16(wide, big), "x");
      CHECK(decoded.text == expected);
      CHECK(decoded.took == (big ? "UTF-16, big endian" : "UTF-16, little endian"));
    }
  }
  CHECK(data::decode_text("\xef\xbb\xbf" + expected, "x").text == expected);
  CHECK(data::decode_text(expected, "x").took.empty());
  const data::DecodedText latin = data::decode_text(
      "R\xfchrwerk, 20 \xb0"
      "C, \xb5N\xb7m, \x80 5",
      "x");
  CHECK(latin.text ==
        "R\xc3\xbchrwerk, 20 \xc2\xb0"
        "C, \xc2\xb5N\xc2\xb7m, \xe2\x82\xac 5");
  CHECK(latin.took == "Latin-1");
  // "時間,トルク" in Shift-JIS.
  const data::DecodedText japanese = data::decode_text("\x8e\x9e\x8a\xd4,\x83\x67\x83\x8b\x83\x4e\n1,2\n", "x");
  CHECK(japanese.took == "Shift-JIS");
  CHECK(japanese.text == "\xe6\x99\x82\xe9\x96\x93,\xe3\x83\x88\xe3\x83\xab\xe3\x82\xaf\n1,2\n");
}

TEST_CASE("a quotation mark or a unit of Windows-1252 makes no Japanese of it, nor the other way round") {
  const auto took = [](const std::string& bytes) { return data::decode_text(bytes, "x").took; };
  CHECK(took("Operator\x92s mixer\nZeit [s];Drehmoment [\xb5N\xb7m]\n") == "Latin-1");
  CHECK(took("Operator\x92s mixer\ntime [s],torque [mN m]\n") == "Latin-1");
  CHECK(took("\x91\xac\x93\x78[rpm],\x83\x67\x83\x8b\x83\x4e[mNm]\n") == "Shift-JIS");  // speed and torque
  CHECK(took("\x91\xac\x93\x78[rpm],M[mNm]\n") == "Shift-JIS");
}

TEST_CASE("tables of Chinese, Korean and Russian programs are told from Latin-1 by their bytes and units") {
  // The bytes are Python's encodings of the texts.
  const auto check = [](const std::string& bytes, const std::string& text, const std::string& took) {
    const data::DecodedText decoded = data::decode_text(bytes, "x");
    CHECK(decoded.text == text);
    CHECK(decoded.took == took);
  };
  check("\xca\xb1\xbc\xe4(s),\xc5\xa4\xbe\xd8(N\xa1\xa4m)\n", "时间(s),扭矩(N·m)\n", "GBK");
  check("\xbd\xc3\xb0\xa3(s),\xc5\xe4\xc5\xa9(N\xa1\xa4m)\n", "시간(s),토크(N·m)\n", "EUC-KR");
  check("\xc2\xf0\xe5\xec\xff (\xf1),\xcc\xee\xec\xe5\xed\xf2 (\xcd\xb7\xec)\n", "Время (с),Момент (Н·м)\n",
        "Windows-1251");
  check("Couple cr\xe9\xe9 [N m], g\xe9n\xe9r\xe9\n", "Couple créé [N m], généré\n", "Latin-1");
  check("t [s],M [\xb5N\xb7m],\xb0,\xd8\xd8\n", "t [s],M [µN·m],°,ØØ\n", "Latin-1");
}

TEST_CASE("what is no text in any of them is refused by name") {
  const TemporaryFolder folder;
  const auto failure = [&](const std::string& bytes) {
    return failure_of(folder, [&] { data::decode_text(bytes, "x.csv"); });
  };
  CHECK(failure(std::string("\xff\xfe\0\0a\0\0\0", 8)).find("65: x.csv: is UTF-32") == 0);
  CHECK(failure(std::string("\xff\xfe"
                            "a\0b",
                            5))
            .find("65: x.csv: is UTF-16, but has an odd number of bytes") == 0);
  CHECK(failure(std::string("\xff\xfe\x00\xdc\x00\x00", 6)).find("is no text") != std::string::npos);
}

TEST_CASE("overlong forms, surrogates and cut-off characters are not UTF-8") {
  for (const std::string bad : {"\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\xff"})
    CHECK_FALSE(data::is_utf8(bad));
  for (const std::string good : {"", "a", "\xc2\xa0", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) CHECK(data::is_utf8(good));
}
