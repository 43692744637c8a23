#include "app/run_lock.h"

#include <fmt/format.h>

#include <fstream>

namespace faba {
namespace {

constexpr const char* kSecond = "This run is not complete. Go on with: ";

}  // namespace

RunLock::RunLock(const std::filesystem::path& dir, const std::string& program)
    : lock_(dir / kFile, dir, fmt::format("{}{} resume {}\n", kSecond, program, dir.string())) {}

bool RunLock::marks(const std::filesystem::path& dir) {
  std::ifstream in(dir / kFile);
  std::string first, second;
  return std::getline(in, first) && std::getline(in, second) && second.starts_with(kSecond);
}

}  // namespace faba
