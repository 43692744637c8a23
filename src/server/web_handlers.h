#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace faba {

/// The protocol of the pages' sockets (web/protocol.md), and the largest message that a page may send, bytes.
inline constexpr const char* kPageProtocol = "faba.1";
inline constexpr std::size_t kMostPageMessage = 1u << 20;

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

}  // namespace faba
