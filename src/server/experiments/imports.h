#pragma once
#include <filesystem>
#include <mutex>
#include <string>

#include "server/experiments/experiment_store.h"

namespace faba {

/// A part of a file that a page uploads into an experiment.
struct ImportPart {
  std::string name;             ///< of the file at the user's computer
  std::uint64_t size = 0;       ///< of the complete file, bytes
  std::uint64_t offset = 0;     ///< of this part, bytes
  std::int64_t modified_s = 0;  ///< time of the file, Unix time; 0: unknown
  std::string drop = {};        ///< to which the video belongs; may be empty
};

/// Uploads of videos into experiments. A file comes in parts, so that an upload continues after a reload of
/// the page or a restart of the lab; it is a hidden file of the experiment until it is complete. Thread-safe.
class Imports {
 public:
  explicit Imports(ExperimentStore& experiments) : experiments_(experiments) {}

  /// Incomplete uploads of an experiment: [{"name", "size", "received"}].
  Json incomplete(const std::string& experiment) const;
  /// Bytes of a file that were received; 0: none.
  std::uint64_t received(const std::string& experiment, const std::string& name, std::uint64_t size) const;
  /// Takes a part, and adds the video to the experiment with the last one. {"received"} or {"received",
  /// "file"}. Throws Error(usage) when the disk has not enough space, when the offset is not the number of
  /// bytes received so far (the message has it), and when the complete file is neither a video nor a picture;
  /// it is then removed.
  Json take(const std::string& experiment, const ImportPart& part, const std::string& bytes);
  /// Removes an incomplete upload; nothing happens if it is not found.
  void cancel(const std::string& experiment, const std::string& name, std::uint64_t size);

 private:
  ExperimentStore& experiments_;
  mutable std::mutex mutex_;
};

}  // namespace faba
