#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "server/access.h"
#include "server/web_handlers.h"

namespace faba {

/// HTTP and WebSocket server on the loopback interface, with Boost.Beast. Connections, sizes and times are
/// limited, so that a misbehaving client cannot block the others.
class WebServer {
 public:
  static constexpr std::size_t kMostBody = 4u << 20;
  static constexpr std::uint64_t kMostUpload = 2ull << 30;
  static constexpr std::size_t kMostUploads = 8;  ///< at the same time
  static constexpr std::size_t kMostConnections = 64;

  /// Binds 127.0.0.1; port 0: any free port. Throws Error(usage) if the port is in use. `uploads`: an
  /// existing folder for request bodies.
  WebServer(unsigned short port, std::filesystem::path uploads);
  ~WebServer();
  unsigned short port() const;

  /// Serves until stop(), which may be called from any thread, also before run().
  void run(const Access& access, WebHandlers handlers);
  void stop();

 private:
  friend class Connection;
  friend struct Upload;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
