#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/toml.h"
#include "server/files/trash.h"
#include "server/jobs/job_list.h"
#include "server/workspace.h"

namespace faba {

/// The recorded runs of a workspace: the folders below runs/ with a recorded run. Thread-safe.
class RunCatalogue {
 public:
  RunCatalogue(const Workspace& workspace, const JobList& jobs, Trash& trash)
      : workspace_(workspace), jobs_(jobs), trash_(trash) {}

  /// An object for each run, newest first (web/protocol.md). Reads only what has changed since the last call;
  /// measuring many new runs takes several calls: until then `measured` is false.
  Json list();
  /// Size of its files, bytes.
  std::uint64_t size(const std::string& name) const;
  /// Moves a run to the trash. Throws Error(usage) with the reason if a process uses the run.
  Trash::Item remove(const std::string& name);
  /// Returns the new name: `to` as a folder name. Throws Error(usage) if it is used, or if a process uses the
  /// run.
  std::string rename(const std::string& name, const std::string& to);
  /// Replaces tags and note of a run, from {"tags": [...], "note"}. Throws Error(usage).
  void set_tags(const std::string& name, const Json& asked);

  /// Its folder. Throws Error(input) if there is no such run.
  std::filesystem::path folder(const std::string& name) const;

 private:
  struct Known {
    std::filesystem::file_time_type manifest, folder;  ///< times of the last changes
    Json card;
  };
  /// What is known of a run, or what its manifest says if it has changed.
  Known look_at(const std::string& name);
  void check_unused(const std::string& name, const std::filesystem::path& dir) const;

  const Workspace& workspace_;
  const JobList& jobs_;
  Trash& trash_;
  mutable std::mutex mutex_;
  std::map<std::string, Known> known_;
};

}  // namespace faba
