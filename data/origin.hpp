#pragma once
// Which files are demcal's own, and whether they are still what it wrote.
//
// A mark of origin stands in every file that demcal writes: "written by demcal, digest " and 32 hexadecimal digits. The
// digits are the XXH3 of the whole file with zeros in their place. The mark is in a comment (CSV, gnuplot, SVG, HTML),
// a key (JSON), the title (STL) or, for HDF5, netCDF and PNG, behind the end that the format knows of, where readers do
// not look. One flipped bit anywhere shows.
#include <string>
#include <string_view>

namespace data {

enum class Origin {
  absent,    ///< there is no file, or an empty one
  ours,      ///< as demcal wrote it
  changed,   ///< written by demcal and changed since, by hand or by damage
  unmarked,  ///< an HDF5 file of demcal's that lost its mark: cut short, or changed by others on purpose
  foreign,   ///< anything else, also folders, pipes and devices
};

/// What is at `path`; links are followed.
Origin origin_of(const std::string& path);
/// The origin of a file with these bytes.
Origin origin_of_bytes(std::string_view bytes);

/// The mark with zeros for a digest, to stand somewhere in the first 4096 or the last 256 bytes of a text.
std::string blank_mark();

/// `content` with the digest in its mark. A mark is added where there is none yet and the file's kind (the ending of
/// `path`: csv, dat, gp, html, json, svg; of a PNG picture its first bytes) has a place for one.
std::string with_mark(std::string content, const std::string& path);

/// Adds the mark to a finished HDF5 or netCDF file. Returns 0 or an errno.
int append_mark(const std::string& path);
/// Takes the mark off, when the file is to be changed by others than demcal.
void remove_mark(const std::string& path);

/// Throws InputError (65) when the file is demcal's, but not as demcal wrote it; with `Strict::yes` also when it has no
/// mark. The remedy says how to get it back.
enum class Strict { no, yes };
void require_unchanged(const std::string& path, const std::string& remedy, Strict strict = Strict::no);

}  // namespace data
