// Uploads of a faulty or malicious client, and what of them and of the user's files can be requested.
#include <doctest/doctest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "core/toml.h"
#include "server/web_server.h"
#include "tests/server/served_lab.h"

using namespace faba;
using test::RawClient;
using test::Served;
using test::status_of;
namespace fs = std::filesystem;

namespace {

const std::string kPicture = [] {
  std::string picture = "P5\n80 64\n255\n";
  for (int i = 0; i < 80 * 64; ++i) picture += char(60 + i % 80);
  return picture;
}();

std::string bytes_of(const Served& lab) { return lab.own() + "Content-Type: application/octet-stream\r\n"; }
Json json_of(const std::string& answer) { return Json::parse(test::body_of(answer)); }

/// A client that begins an upload and sends a part of it.
std::unique_ptr<RawClient> started(const Served& lab, std::size_t length) {
  auto c = std::make_unique<RawClient>(lab.port);
  c->send(fmt::format("POST /api/upload?name=a.pgm HTTP/1.1\r\n{}Content-Length: {}\r\n\r\nP5", bytes_of(lab),
                      length));
  return c;
}

// The status of an upload; a client of which the connection was closed may be counted for a moment.
int upload_until(const Served& lab, int wanted) {
  int status = 0;
  for (int k = 0; k < 200 && status != wanted;
       ++k, std::this_thread::sleep_for(std::chrono::milliseconds(25)))
    status = status_of(lab.ask("POST /api/upload?name=a.pgm", bytes_of(lab), kPicture));
  return status;
}

}  // namespace

TEST_CASE("S7: only some uploads at the same time; one that was interrupted makes room") {
  const Served lab;
  std::vector<std::unique_ptr<RawClient>> slow;
  for (std::size_t k = 0; k < WebServer::kMostUploads; ++k) slow.push_back(started(lab, 1000));
  CHECK(upload_until(lab, 429) == 429);
  CHECK(status_of(lab.get("/api/about")) == 200);
  slow.pop_back();
  CHECK(upload_until(lab, 200) == 200);
}

TEST_CASE("S7: an upload without a length, or with one that is too large, is refused before it is read") {
  const Served lab;
  RawClient chunked(lab.port);
  chunked.send("POST /api/upload?name=a.pgm HTTP/1.1\r\n" + bytes_of(lab) +
               "Transfer-Encoding: chunked\r\n\r\n1\r\nP\r\n");
  CHECK(status_of(chunked.answer()) == 411);
  for (const std::string& length : {std::string("3000000000"), std::string("18446744073709551615")}) {
    RawClient big(lab.port);
    big.send("POST /api/upload?name=a.pgm HTTP/1.1\r\n" + bytes_of(lab) + "Content-Length: " + length +
             "\r\n\r\n");
    CHECK(status_of(big.answer()) == 413);
  }
  RawClient more(lab.port);
  more.send("POST /api/experiments/x/imports?name=a HTTP/1.1\r\n" + bytes_of(lab) +
            "Content-Length: 5000000\r\n\r\n");
  CHECK(status_of(more.answer()) == 413);
}

TEST_CASE("S7: an upload that sends a byte now and then ends") {
  const Served lab;
  const auto slow = started(lab, 1 << 20);
  const auto began = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - began < std::chrono::seconds(40) && slow->send("x"))
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto lasted = std::chrono::steady_clock::now() - began;
  CHECK(lasted > std::chrono::seconds(25));
  CHECK(lasted < std::chrono::seconds(39));
}

TEST_CASE("S9: scripts in files of the user do not run, whatever their name") {
  const Served lab;
  fs::create_directories(lab.folder() / "runs/a");
  for (const char* name : {"a.svg", "a.js", "a.css", "a.html", "a.HTML", "a.xhtml", "a.xml", "a.wasm"}) {
    write_file(lab.folder() / "runs/a" / name,
               "<svg xmlns='http://www.w3.org/2000/svg'><script href='a.js'/></svg>");
    for (const std::string path : {"/runs/a/", "/api/runs/a/"}) {
      const std::string a = lab.get(path + name);
      INFO(a);
      CHECK(status_of(a) == 200);
      CHECK(a.find("script-src") == std::string::npos);  // default-src 'none' applies
      CHECK(a.find("default-src 'none'") != std::string::npos);
      CHECK(a.find("javascript") == std::string::npos);
      CHECK(a.find("text/css") == std::string::npos);
      CHECK(a.find("X-Content-Type-Options: nosniff") != std::string::npos);
    }
  }
}

TEST_CASE("S8: of the lab's private folder only rendered pictures can be requested") {
  const Served lab;
  const Json found = json_of(lab.ask("POST /api/upload?name=page.html", bytes_of(lab), kPicture));
  CHECK(status_of(lab.get(found["url"])) == 200);
  const std::string upload = found["upload"];
  for (const std::string& name :
       {std::string("open.html"), upload, std::string("..%2fopen.html"), std::string("shown-1")}) {
    const std::string a = lab.get("/api/uploads/" + name);
    INFO(a);
    CHECK(status_of(a) >= 400);
    CHECK(a.find(lab.token) == std::string::npos);
  }
}

TEST_CASE("S6: parent folders in any encoding are refused, in every request that has a file name") {
  const Served lab;
  const std::string json = lab.own() + "Content-Type: application/json\r\n";
  const std::string outside = fs::canonical(lab.folder()).parent_path().filename();
  for (const char* up :
       {"..", "%2e%2e", "%2E%2E", ".%2e", "%2e.", "..%2f..", "..%5c..", "%252e%252e", "%c0%ae%c0%ae",
        "%e0%80%ae%e0%80%ae", "..;", "..%00", "..%0a", "%uff0e%uff0e", "....//", "..%c0%af"}) {
    for (const char* request :
         {"/api/videos/frame?file=", "/api/videos/about?file=", "/api/videos/thumbnail.png?file=",
          "/api/folders?path=", "/api/pictures/shown.png?file=", "/api/results?page=runs/",
          "/api/tracks/result?folder=runs/", "/api/tracks/file/tracks.csv?folder=", "/api/runs/", "/runs/",
          "/api/scenes/", "/api/uploads/", "/experiments/x/results/", "/api/experiments/"}) {
      const std::string a = lab.get(fmt::format("{}{}/secret.txt", request, up));
      INFO(request, up, ": ", a.substr(0, 300));
      CHECK(status_of(a) >= 400);
      CHECK(status_of(a) < 500);
      CHECK(a.find("confidential content") == std::string::npos);
    }
    const std::string name = fmt::format("{}/{}/secret.txt", up, outside);
    for (const auto& [request, body] :
         {std::pair<const char*, Json>{"POST /api/pictures/detect", {{"file", name}}},
          {"POST /api/tracks", {{"file", name}}},
          {"POST /api/jobs", {{"kind", "drop"}, {"values", {{"picture", name}}}}},
          {"POST /api/results/compare", {{"page", name}}},
          {"POST /api/experiments/x/videos", {{"file", name}}}}) {
      const std::string a = lab.ask(request, json, body.dump(-1, ' ', false, Json::error_handler_t::replace));
      INFO(request, " ", body.dump());
      CHECK(status_of(a) >= 400);
      CHECK(status_of(a) < 500);
    }
  }
}

TEST_CASE("names with HTML, quotes, newlines, shell and bidi characters stay names") {
  const Served lab;
  const std::string json = lab.own() + "Content-Type: application/json\r\n";
  for (const std::string name :
       {"<img src=x onerror=alert(1)>.pgm", "a\"'`$(touch pwned);|&.pgm", "line\nbreak.pgm", "-rf.pgm",
        "--json=x.pgm", "\u202Emgp.exe.pgm", "a b\t.pgm", "%00.pgm", "\\\\host\\a.pgm", "CON.pgm", "~.pgm",
        "$HOME.pgm", "*.pgm"}) {
    INFO(name);
    write_file(lab.folder() / name, kPicture);
    const std::string asked = Json{{"kind", "drop"}, {"values", {{"picture", name}}}}.dump();
    const std::string a = lab.ask("POST /api/jobs", json, asked);
    REQUIRE(status_of(a) == 200);
    const std::string path = fmt::format("/api/jobs/{}", json_of(a)["id"].get<int>());
    Json job;
    for (int k = 0; k < 400; ++k, std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
      job = json_of(lab.get(path));
      if (job["state"] != "running" && job["state"] != "waiting") break;
    }
    CHECK(job["words"][1] == "./" + name);  // one word, whatever is in it
    // The command has read the file: it reports that the picture has no drop.
    INFO(job.dump());
    CHECK(job["error"].get<std::string>().find("no drop edge") != std::string::npos);
  }
  CHECK_FALSE(fs::exists(lab.folder() / "pwned"));
}

TEST_CASE("S7: a body that is nested too deeply is refused, and so is a file of a run") {
  const Served lab;
  const std::string json = lab.own() + "Content-Type: application/json\r\n";
  REQUIRE(status_of(lab.ask("POST /api/experiments", json, R"({"title":"x"})")) == 200);
  const auto nested = [](const std::string& open, const std::string& close) {
    std::string text;
    for (int k = 0; k < 200000; ++k) text += open;
    text += "1";
    for (int k = 0; k < 200000; ++k) text += close;
    return text;
  };
  for (const std::string& deep : {nested("{\"a\":", "}"), nested("[", "]")})
    for (const auto& [request, before] :
         {std::pair<const char*, const char*>{"POST /api/check", "{\"scenario\":"},
          {"POST /api/jobs", "{\"kind\":\"drop\",\"values\":"},
          {"POST /api/experiments/x", "{\"changes\":"},
          {"POST /api/studies", "{\"kind\":\"identify\",\"study\":"},
          {"POST /api/tracks/detect", "{\"file\":"},
          {"POST /api/runs/x/tags", "{\"tags\":"}}) {
      INFO(request);
      const std::string a = lab.ask(request, json, before + deep + "}");
      CHECK(status_of(a) == 422);
    }
  fs::create_directories(lab.folder() / "runs/deep");
  write_file(lab.folder() / "runs/deep/scenario.toml", "title = 'x'\n");
  write_file(lab.folder() / "runs/deep/manifest.json", "{\"seed\":" + nested("[", "]") + "}");
  CHECK(json_of(lab.get("/api/runs")).empty());
  CHECK(status_of(lab.get("/api/about")) == 200);
}
