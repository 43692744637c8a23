#pragma once
#include <sys/socket.h>

#include <cstdint>
#include <string>

#include "core/toml.h"
#include "tests/server/lab_access.h"

namespace faba::test {

/// A page of the lab: its WebSocket is open while the object lives, and it sends requests with its number.
class PageClient {
 public:
  explicit PageClient(const LabAccess& lab) : lab_(lab), socket_(lab.port) {
    socket_.send("GET /ws HTTP/1.1\r\n" + lab.own() +
                 "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: faba.1\r\n\r\n");
    // The first message is {"say": "hello", "page": N, ...}.
    std::string got;
    const std::string key = "\"page\":";
    for (int i = 0; i < 50 && page == 0; ++i) {
      got += socket_.some();
      if (const auto at = got.find(key); at != std::string::npos && got.find('}', at) != std::string::npos)
        page = std::strtoull(got.c_str() + at + key.size(), nullptr, 10);
    }
  }
  /// The answer, with "status".
  Json post(const std::string& path, Json body = Json::object()) const {
    const std::string a =
        lab_.ask("POST " + path, lab_.own() + "Content-Type: application/json\r\n", body.dump());
    Json j = Json::parse(body_of(a), nullptr, false);
    if (!j.is_object()) j = {{"body", body_of(a)}};
    j["status"] = status_of(a);
    return j;
  }
  Json get(const std::string& path) const { return Json::parse(body_of(lab_.get(path)), nullptr, false); }
  /// A request with a fresh permit for `what`.
  Json armed(const std::string& what, Json body = Json::object()) const {
    body["page"] = page;
    body["permit"] = post("/api/bench/permit", {{"page", page}, {"what", what}}).value("permit", "");
    return post("/api/bench/" + what, body);
  }

  std::uint64_t page = 0;

 private:
  const LabAccess& lab_;
  RawClient socket_;
};

}  // namespace faba::test
