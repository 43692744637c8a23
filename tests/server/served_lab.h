#pragma once
#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <future>
#include <string>
#include <thread>

#include "core/file.h"
#include "server/lab.h"
#include "tests/server/raw_client.h"
#include "tests/temporary_folder.h"

namespace faba::test {

namespace fs = std::filesystem;

/// A lab server, stopped by the destructor.
class Served {
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
      const std::string before = "http://127.0.0.1:", between = "/?token=";
      const std::size_t at = address.find(between);
      if (address.starts_with(before) && at != std::string::npos) {
        port = static_cast<unsigned short>(std::stoi(address.substr(before.size(), at - before.size())));
        token = address.substr(at + between.size());
      }
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

  /// Header lines of the lab's page, with the cookie.
  std::string own() const {
    return fmt::format(
        "Host: 127.0.0.1:{0}\r\nCookie: faba-{0}={1}\r\nOrigin: http://127.0.0.1:{0}\r\nSec-Fetch-Site: "
        "same-origin\r\n",
        port, token);
  }
  std::string ask(const std::string& line, const std::string& headers, const std::string& body = "") const {
    RawClient c(port);
    c.send(fmt::format("{} HTTP/1.1\r\n{}Content-Length: {}\r\n\r\n{}", line, headers, body.size(), body));
    return c.answer();
  }
  std::string get(const std::string& path) const { return ask("GET " + path, own()); }

  unsigned short port = 0;
  std::string token;
  fs::perms door_mode{}, folder_mode{};
  const fs::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace faba::test
