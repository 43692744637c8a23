#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace faba {

/// What a result was computed from. Together with the version of the program it determines the result;
/// date, threads and output files are not part of it.
struct Provenance {
  struct Input {
    std::string path;    ///< as the user gave it
    std::string sha256;  ///< content_digest()
  };
  std::vector<Input> inputs;
  /// Options that the user gave and that change the result, with their values: {"--shrink", "2"}.
  std::vector<std::pair<std::string, std::string>> options;

  /// Adds the digest of an input; an empty path, and one that was added before, is ignored.
  void add(const std::filesystem::path& input);
};

/// SHA-256 of the content of an input, 64 hexadecimal digits: of a file, or, for a picture sequence and a run
/// directory (its video and flow), of the output of `sha256sum` for its files in their order. Throws
/// Error(input).
std::string content_digest(const std::filesystem::path& input);

}  // namespace faba
