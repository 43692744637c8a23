#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace faba {

/// Options of `faba lab`.
struct LabOptions {
  std::filesystem::path workspace = ".";       ///< folder for input and output files
  std::filesystem::path scenes;                ///< gallery, used if the workspace has none
  std::vector<std::filesystem::path> allowed;  ///< folders outside the workspace that pages may read
  std::filesystem::path program;               ///< program that runs the jobs
  std::filesystem::path scene;                 ///< initial scene; empty: none
  std::filesystem::path pages;                 ///< files of the page, for development; empty: embedded files
  unsigned short port = 0;                     ///< 0: any free port
  unsigned threads = 0;  ///< 0: all hardware threads but one, which is left to the browser
  /// Called once when the server is ready: the URL with the token, and a file that redirects a browser to it.
  std::function<void(const std::string& address, const std::filesystem::path& door)> ready;
  const std::atomic<bool>* stop = nullptr;
};

/// Serves the live lab until `stop` is true. Throws, before serving, Error(usage) if the port is in use, and
/// for an invalid scene the Error that its run would throw.
void serve_lab(const LabOptions& o);

}  // namespace faba
