#pragma once
#include "server/api/lab_services.h"

namespace faba {

/// HTTP interface of the lab; see web/protocol.md. Thread-safe.
class Api {
 public:
  /// `pictures`: a private folder for rendered images and uploads. `pages`: folder with the files of the
  /// page, for development; empty: the files embedded in the program.
  /// `news`: sends a message to all pages.
  Api(const Workspace& workspace, JobList& jobs, std::filesystem::path pictures, std::filesystem::path pages,
      std::function<void(const Json&)> news);

  /// The page that steers, which alone may arm the coils of a bench; 0: none.
  void steering(std::uint64_t page) { bench_.steering(page); }

  /// Never throws: errors become responses with a status and {"where", "what"}.
  WebResponse answer(const WebRequest& r);

 private:
  WebResponse page_file(const std::string& name) const;

  std::filesystem::path pages_;
  ExperimentStore experiments_;
  BenchConsole bench_;
  Imports imports_{experiments_};
  Trash trash_;
  RunCatalogue runs_;
  LabServices lab_;
  Routes routes_;
};

}  // namespace faba
