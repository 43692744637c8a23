#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace faba {

/// The parsed target of a request.
struct WebTarget {
  std::string path;                          ///< decoded; begins with '/', no empty, "." or ".." parts
  std::map<std::string, std::string> query;  ///< decoded
};
/// Empty for invalid targets: invalid escapes, control characters, "..".
std::optional<WebTarget> parse_target(std::string_view target);

/// A part of a file: [begin, end).
struct ByteRange {
  std::uint64_t begin = 0, end = 0;
};
/// Parses "bytes=0-499", "bytes=500-" or "bytes=-500" for a file of `size` bytes. Empty for anything else;
/// the response is then the complete file.
std::optional<ByteRange> parse_range(std::string_view header, std::uint64_t size);

}  // namespace faba
