#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace faba {

/// The target of a request, taken apart.
struct WebTarget {
  std::string path;                          ///< decoded; begins with '/', no empty, "." or ".." parts
  std::map<std::string, std::string> query;  ///< decoded
};
/// None for what no page of ours asks: bad escapes, control characters, parts that lead upwards.
std::optional<WebTarget> parse_target(std::string_view target);

/// A part of a file: [begin, end).
struct ByteRange {
  std::uint64_t begin = 0, end = 0;
};
/// Reads "bytes=0-499", "bytes=500-" or "bytes=-500" for a file of `size` bytes. None for anything else,
/// which is answered with the whole file.
std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t size);

}  // namespace faba
