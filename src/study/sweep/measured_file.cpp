#include "study/sweep/measured_file.h"

#include <zlib.h>

#include <cstring>

#include "core/file.h"

namespace faba {
namespace {

constexpr char kMeasuredKind[] = "faba measured 1\n";
constexpr std::size_t kMeasuredHead = sizeof kMeasuredKind - 1 + 4;  // and the checksum

std::filesystem::path measured_path(const std::filesystem::path& folder, const std::string& key) {
  return folder / (key + ".measured");
}

std::string head_of_measured(const std::uint8_t* content, std::size_t size) {
  const auto sum = std::uint32_t(crc32_z(0, content, size));
  std::string head(kMeasuredKind, kMeasuredHead);
  std::memcpy(head.data() + kMeasuredHead - 4, &sum, 4);
  return head;
}

}  // namespace

std::optional<Archive> read_measured(const std::filesystem::path& folder, const std::string& key) {
  if (folder.empty() || !std::filesystem::is_regular_file(measured_path(folder, key))) return {};
  const std::string bytes = read_file(measured_path(folder, key));
  if (bytes.size() < kMeasuredHead) return {};
  std::vector<std::uint8_t> content(bytes.begin() + std::ptrdiff_t(kMeasuredHead), bytes.end());
  if (!bytes.starts_with(head_of_measured(content.data(), content.size()))) return {};
  return Archive(std::move(content));
}

void write_measured(const std::filesystem::path& folder, const std::string& key, const Archive& content) {
  if (folder.empty()) return;
  std::filesystem::create_directories(folder);
  std::string bytes = head_of_measured(content.bytes().data(), content.bytes().size());
  bytes.append(reinterpret_cast<const char*>(content.bytes().data()), content.bytes().size());
  write_file(measured_path(folder, key), bytes);
}

}  // namespace faba
