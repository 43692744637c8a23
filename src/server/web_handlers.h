#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace faba {

/// WebSocket protocol of the pages (web/protocol.md), and maximum message size of a page, bytes.
inline constexpr const char* kPageProtocol = "faba.1";
inline constexpr std::size_t kMostPageMessage = 1u << 20;

/// An authorised request.
struct WebRequest {
  std::string method;
  std::string path;                          ///< decoded, without the query
  std::map<std::string, std::string> query;  ///< decoded, without the token
  std::string body;                          ///< up to WebServer::kMostBody bytes
  std::filesystem::path
      upload;  ///< body of a request to /api/upload and below, in a file that is removed afterwards
};

struct WebResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::filesystem::path file = {};  ///< if not empty, its content is the body, with range requests; no links
  bool keep = false;                ///< may be cached for an hour
  bool report = false;              ///< a file of the user, such as a report: inline style, no script
};

/// A connected page. Thread-safe; messages to a disconnected page are discarded.
class PageSocket {
 public:
  virtual ~PageSocket() = default;
  virtual std::uint64_t id() const = 0;
  /// Sends all texts in order. A page that does not read them is disconnected.
  virtual void send_text(std::string text) = 0;
  /// Sends the newest frame: while one is being sent, only the latest of the next ones is kept.
  virtual void send_frame(std::shared_ptr<const std::string> bytes) = 0;
};
using PageSocketRef = std::shared_ptr<PageSocket>;

/// Callbacks of the server.
struct WebHandlers {
  /// Called on a worker thread; must not throw.
  std::function<WebResponse(const WebRequest&)> answer;
  // Called on the server's thread; must return quickly:
  std::function<void(const PageSocketRef&)> opened;
  std::function<void(const PageSocketRef&, std::string_view text)> received;
  std::function<void(const PageSocketRef&)> closed;
};

}  // namespace faba
