#pragma once
#include <atomic>
#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include "core/file.h"
#include "server/lab.h"
#include "tests/server/lab_access.h"
#include "tests/temporary_folder.h"

namespace faba::test {

namespace fs = std::filesystem;

/// A lab server, stopped by the destructor.
class Served : public LabAccess {
 public:
  Served() : folder_("lab") {
    fs::create_directories(folder_.path() / "scenes");
    write_file(
        folder_.path() / "scenes/one.toml",
        "# A small one.\ntitle = 'One'\n[arena]\ntype = 'drop'\nradius_px = 100\n[[swarm]]\ncount = 10\n");
    write_file(folder_.path() / "secret.txt", "confidential content");
    std::promise<void> ready;
    LabOptions o;
    o.workspace = folder_.path();
    o.program = FABA_PROGRAM;
    o.threads = 1;
    o.stop = &stop_;
    o.ready = [&](const std::string& address, const fs::path& door) {
      read_address(address);
      door_mode = fs::status(door).permissions();
      folder_mode = fs::status(door.parent_path()).permissions();
      ready.set_value();
    };
    thread_ = std::thread([this, o] { serve_lab(o); });
    ready.get_future().wait();
  }
  ~Served() {
    stop_ = true;
    thread_.join();
  }

  fs::perms door_mode{}, folder_mode{};
  const fs::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace faba::test
