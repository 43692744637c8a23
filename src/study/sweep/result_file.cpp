#include "study/sweep/result_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "study/sweep/program_version.h"

namespace faba {
namespace {

constexpr double kSyncPeriod = 5;               // s
constexpr std::size_t kReadBlock = 1 << 20;     // bytes that are read at a time
constexpr std::uint32_t kMostBytes = 64 << 20;  // of a record; more is damage

/// First bytes of a file. All numbers of a file are little-endian.
struct FileHead {
  char kind[16] = "faba results 1";
  char study[24] = {};
  char version[20] = {};
  std::uint32_t checksum = 0;
};
static_assert(sizeof(FileHead) == 64);

/// A record: this head, then `bytes` - kCounted bytes of values (doubles) or of the text of a failure.
struct RecordHead {
  std::uint32_t checksum = 0;  ///< of everything that follows
  std::uint32_t bytes = 0;     ///< that follow
  std::uint64_t round = 0, task = 0;
  float seconds = 0;
  std::uint32_t failed = 0;
};
static_assert(sizeof(RecordHead) == 32);
constexpr std::size_t kCounted = sizeof(RecordHead) - 8;

std::uint32_t checksum_of(const void* p, std::size_t n) {
  return std::uint32_t(crc32_z(0, static_cast<const unsigned char*>(p), n));
}

FileHead head_of(const std::string& study_hash) {
  FileHead h;
  study_hash.copy(h.study, sizeof h.study - 1);
  const std::string version = program_version();
  version.copy(h.version, sizeof h.version - 1);
  h.checksum = checksum_of(&h, sizeof h - sizeof h.checksum);
  return h;
}

std::string_view text_of(const char* field, std::size_t size) { return {field, strnlen(field, size)}; }

void check_head(const FileHead& h, const std::filesystem::path& file, const std::string& study_hash) {
  if (text_of(h.kind, sizeof h.kind) != FileHead().kind ||
      h.checksum != checksum_of(&h, sizeof h - sizeof h.checksum))
    throw Error(Errc::input, file.string(),
                "is not a file of results of this version of faba; if it is in the directory of a study, "
                "delete it to compute its results again");
  if (text_of(h.version, sizeof h.version) != program_version())
    throw Error(Errc::usage, file.string(),
                fmt::format("was computed by faba {}, this is faba {}; use one program for all parts of a "
                            "study, or delete the file to compute its results again",
                            text_of(h.version, sizeof h.version), program_version()));
  if (text_of(h.study, sizeof h.study) != study_hash)
    throw Error(Errc::usage, file.string(),
                fmt::format("contains results of a different study ({}, this study is {})",
                            text_of(h.study, sizeof h.study), study_hash));
}

// Length of the record at the start of `in`; 0 if it is not complete, or damaged.
std::size_t record_in(std::span<const char> in, RecordHead& head) {
  if (in.size() < sizeof head) return 0;
  std::memcpy(&head, in.data(), sizeof head);
  const std::size_t all = std::size_t(head.bytes) + 8;
  if (head.bytes < kCounted || head.bytes > kMostBytes || in.size() < all) return 0;
  return checksum_of(in.data() + 4, all - 4) == head.checksum ? all : 0;
}

/// Bytes of a file, read in blocks.
class BlockReader {
 public:
  BlockReader(const std::filesystem::path& file, std::uint64_t from) : in_(file, std::ios::binary) {
    in_.seekg(std::streamoff(from));
  }
  std::span<const char> rest() const { return std::span(buffer_).subspan(used_); }
  void use(std::size_t n) { used_ += n; }
  /// Reads another block behind rest(); false at the end of the file.
  bool more() {
    buffer_.erase(buffer_.begin(), buffer_.begin() + std::ptrdiff_t(used_));
    used_ = 0;
    const std::size_t before = buffer_.size();
    buffer_.resize(before + kReadBlock);
    in_.read(buffer_.data() + before, kReadBlock);
    buffer_.resize(before + std::size_t(in_.gcount()));
    return buffer_.size() > before;
  }

 private:
  std::ifstream in_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
};

TaskResult result_of(const RecordHead& head, const char* content, std::vector<double>& values) {
  TaskResult r{{head.round, head.task}, double(head.seconds), {}, {}};
  const std::size_t bytes = head.bytes - kCounted;
  if (head.failed != 0) {
    r.failure = {content, bytes};
    return r;
  }
  values.resize(bytes / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), content, bytes);
  r.values = values;
  return r;
}

}  // namespace

std::filesystem::path partial_name(const std::filesystem::path& file) { return file.string() + ".part"; }

ResultFile::ResultFile(std::filesystem::path file, const std::string& study_hash)
    : file_(std::move(file)), out_(partial_name(file_)) {
  const FileHead head = head_of(study_hash);
  out_.append(std::string_view(reinterpret_cast<const char*>(&head), sizeof head));
}

void ResultFile::add(const TaskResult& r) {
  RecordHead head{0, 0, r.id.round, r.id.task, float(r.seconds), r.failure.empty() ? 0U : 1U};
  const void* content = r.failure.empty() ? static_cast<const void*>(r.values.data()) : r.failure.data();
  const std::size_t bytes = r.failure.empty() ? r.values.size_bytes() : r.failure.size();
  head.bytes = std::uint32_t(kCounted + bytes);
  std::string record(reinterpret_cast<const char*>(&head), sizeof head);
  record.append(static_cast<const char*>(content), bytes);
  head.checksum = checksum_of(record.data() + 4, record.size() - 4);
  std::memcpy(record.data(), &head.checksum, sizeof head.checksum);
  out_.append(std::string_view(record));
  const auto now = std::chrono::steady_clock::now();
  if (std::chrono::duration<double>(now - synced_).count() < kSyncPeriod) return;
  out_.sync();
  synced_ = now;
}

void ResultFile::complete() {
  out_.sync();
  out_.close();
  rename_complete(partial_name(file_), file_);
}

std::uint64_t read_results(const std::filesystem::path& file, const std::string& study_hash,
                           std::uint64_t from, const std::function<void(const TaskResult&)>& take) {
  const bool partial = file.extension() == ".part";
  BlockReader in(file, from);
  bool more = in.more();
  if (from == 0) {
    FileHead head;
    if (in.rest().size() < sizeof head && partial) return 0;
    if (in.rest().size() < sizeof head)
      throw Error(Errc::input, file.string(), "is truncated; delete it to compute its results again");
    std::memcpy(&head, in.rest().data(), sizeof head);
    check_head(head, file, study_hash);
    in.use(sizeof head);
    from = sizeof head;
  }
  std::vector<double> values;
  while (more || !in.rest().empty()) {
    RecordHead head;
    const std::size_t length = record_in(in.rest(), head);
    if (length == 0) {
      more = in.more();
      if (more) continue;
      if (in.rest().empty() || partial) break;
      throw Error(Errc::input, file.string(),
                  fmt::format("is damaged at byte {}; delete it to compute its results again", from));
    }
    take(result_of(head, in.rest().data() + sizeof head, values));
    in.use(length);
    from += length;
  }
  return from;
}

}  // namespace faba
