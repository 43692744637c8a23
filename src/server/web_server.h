#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/access.h"

namespace faba {

/// A request that may be answered: it has passed Access.
struct WebRequest {
  std::string method;
  std::string path;                          ///< decoded, without the query
  std::map<std::string, std::string> query;  ///< decoded, without the token
  std::string body;                          ///< up to WebServer::kMostBody bytes
  std::filesystem::path upload;  ///< of a request to /api/upload: the body, in a file that is removed after
                                 ///< the answer
};

struct WebResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::filesystem::path file = {};  ///< when given, its content is the body, in parts if the page wants
  bool keep = false;                ///< the browser may keep it for an hour
  bool report = false;              ///< a page that the program wrote: style within, no script
};

/// One page that is connected by a socket. Thread-safe; what is said to a page that has gone is lost.
class PageSocket {
 public:
  virtual ~PageSocket() = default;
  virtual std::uint64_t id() const = 0;
  /// Everything said is sent, in order. A page that does not read what it is told is cut off.
  virtual void say(std::string text) = 0;
  /// Newest wins: while one is on its way the next ones take each other's place.
  virtual void show(std::shared_ptr<const std::string> bytes) = 0;
};
using PageSocketRef = std::shared_ptr<PageSocket>;

/// What the server asks of the program.
struct WebHandlers {
  /// On one of a few worker threads; must not throw.
  std::function<WebResponse(const WebRequest&)> answer;
  // On the server's own thread, quickly:
  std::function<void(const PageSocketRef&)> opened;
  std::function<void(const PageSocketRef&, std::string_view text)> heard;
  std::function<void(const PageSocketRef&)> closed;
};

/// Serves pages and sockets on the loopback interface, with Boost.Beast. Bounded in connections, sizes and
/// times: a page that misbehaves costs itself.
class WebServer {
 public:
  static constexpr std::size_t kMostBody = 4u << 20;
  static constexpr std::uint64_t kMostUpload = 2ull << 30;
  static constexpr std::size_t kMostMessage = 1u << 20;  ///< of a socket
  static constexpr std::size_t kMostConnections = 64;
  static constexpr const char* kSubprotocol = "faba.1";

  /// Binds 127.0.0.1; port 0: any that is free. Throws Error(usage) when the port is taken. `uploads`: an
  /// existing folder for request bodies.
  WebServer(unsigned short port, std::filesystem::path uploads);
  ~WebServer();
  unsigned short port() const;

  /// Serves until stop(), which may be called from any thread or before.
  void run(const Access& access, WebHandlers handlers);
  void stop();

 private:
  friend class Connection;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
