#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

namespace faba {

/// How `faba lab` is called.
struct LabOptions {
  std::filesystem::path workspace = ".";  ///< that it reads and writes in
  std::filesystem::path scenes;           ///< the gallery of a workspace without one
  std::filesystem::path program;          ///< that does the jobs
  std::filesystem::path scene;            ///< to begin with; empty: none
  std::filesystem::path pages;  ///< page's files, while they are worked on; empty: those in the program
  unsigned short port = 0;      ///< 0: any that is free
  unsigned threads = 0;
  /// Called once, when it can be opened: the address with the token, and a file that leads a browser there.
  std::function<void(const std::string& address, const std::filesystem::path& door)> ready;
  const std::atomic<bool>* stop = nullptr;
};

/// Serves the live lab until asked to stop. Throws Error(usage) for a port that is taken or a scene that is
/// wrong, before it serves anything.
void serve_lab(const LabOptions& o);

}  // namespace faba
