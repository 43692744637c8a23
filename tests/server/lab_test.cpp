// The complete server with malicious and faulty clients: S1 to S9 of RELIABILITY.
#include "server/lab.h"

#include <doctest/doctest.h>

#include <fstream>
#include <thread>

#include "core/error.h"
#include "core/file.h"
#include "core/toml.h"
#include "server/web_server.h"
#include "tests/server/raw_client.h"
#include "tests/server/served_lab.h"

using namespace faba;
using test::RawClient;
using test::Served;
using test::status_of;
namespace fs = std::filesystem;

namespace {

const std::string kUpgrade =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
    "dGhlIHNhbXBsZSBub25jZQ==\r\n";

// Resident memory of this process, bytes.
std::size_t resident() {
  std::ifstream in("/proc/self/statm");
  std::size_t all = 0, pages = 0;
  in >> all >> pages;
  return pages * std::size_t(::sysconf(_SC_PAGESIZE));
}

}  // namespace

TEST_CASE("a run is deleted and restored; deleted files cannot be requested") {
  const Served lab;
  const fs::path run = lab.folder() / "runs/one";
  fs::create_directories(run);
  write_file(run / "manifest.json", R"({"version":"0.1.0","title":"One","complete":true})");
  write_file(run / "scenario.toml", "[[swarm]]\ncount = 1\n");
  write_file(run / "series.csv", "confidential content");
  const std::string json = lab.own() + "Content-Type: application/json\r\n";
  const auto body = [](const std::string& answer) { return Json::parse(test::body_of(answer)); };
  const Json list = body(lab.get("/api/runs"));
  REQUIRE(list.size() == 1);
  const Json size = body(lab.get("/api/runs/one/size"));
  CHECK(size["bytes"] == list[0]["bytes"]);

  // Other web pages cannot send this request.
  CHECK(status_of(lab.ask("DELETE /api/runs/one", lab.own())) == 415);
  const Json item = body(lab.ask("DELETE /api/runs/one", json));
  CHECK(item["bytes"] == size["bytes"]);
  CHECK_FALSE(fs::exists(run));
  CHECK(body(lab.get("/api/runs")).empty());
  CHECK(body(lab.get("/api/trash")) == Json::array({item}));
  const std::string hidden = fs::directory_iterator(lab.folder() / ".faba-trash")->path().filename();
  const std::string file = fmt::format(".faba-trash/{}/{}/0/series.csv", hidden, item["id"].get<int>());
  REQUIRE(fs::exists(lab.folder() / file));
  for (const char* before :
       {"/api/runs/../", "/api/runs/%2e%2e/", "/runs/%2e%2e%2f", "/runs/../", "/", "/api/"}) {
    const std::string answer = lab.get(before + file);
    INFO(before);
    CHECK(status_of(answer) >= 400);
    CHECK(answer.find("confidential") == std::string::npos);
  }
  const std::string undo = fmt::format("POST /api/trash/{}/undo", item["id"].get<int>());
  CHECK(body(lab.ask(undo, json, "{}"))["name"] == "runs/one");
  CHECK(read_file(run / "series.csv") == "confidential content");
  CHECK(status_of(lab.ask(undo, json, "{}")) == 404);
  CHECK(status_of(lab.ask("DELETE /api/runs/none", json)) == 404);
  CHECK(status_of(lab.ask("DELETE /api/runs/..", json)) >= 400);

  CHECK(body(lab.ask("POST /api/runs/one/rename", json, R"({"to":"../two"})"))["name"] == "two");
  CHECK(status_of(lab.ask("POST /api/runs/two/tags", json, R"({"tags":["a"],"note":"b"})")) == 200);
  CHECK(body(lab.get("/api/runs"))[0]["tags"] == Json::array({"a"}));
}

TEST_CASE("the lab answers requests of its page") {
  const Served lab;
  CHECK(status_of(lab.get("/api/about")) == 200);
  const Json scenes = Json::parse(test::body_of(lab.get("/api/scenes")));
  REQUIRE(scenes.size() == 1);
  CHECK(scenes[0]["title"] == "One");
  CHECK(scenes[0]["about"] == "A small one.");
  CHECK(scenes[0]["cells"] == 10);
  CHECK(Json::parse(test::body_of(lab.get("/api/scenes/one")))["scenario"]["arena"]["type"] == "drop");
  CHECK(test::body_of(lab.get("/api/scenes/one/picture.png")).starts_with("\x89PNG"));
  CHECK(status_of(lab.get("/api/scenes/none")) == 404);
  CHECK(status_of(lab.get("/nothing")) == 404);
  const std::string checked = lab.ask("POST /api/check", lab.own() + "Content-Type: application/json\r\n",
                                      R"({"scenario":{"swarm":[{"model":{"type":"dipole","sped":1}}]}})");
  const Json wrong = Json::parse(test::body_of(checked));
  CHECK(wrong["ok"] == false);
  CHECK(wrong["where"] == "swarm[0].model.sped");
  // The token is replaced by the cookie and does not remain in the address.
  const std::string first =
      lab.ask("GET /?token=" + lab.token, fmt::format("Host: 127.0.0.1:{}\r\n", lab.port));
  CHECK(status_of(first) == 303);
  CHECK(first.find("Location: /\r\n") != std::string::npos);
  CHECK(first.find("HttpOnly; SameSite=Strict") != std::string::npos);
  // One connection serves several requests.
  RawClient c(lab.port);
  for (int i = 0; i < 3; ++i) {
    c.send("GET /api/about HTTP/1.1\r\n" + lab.own() + "\r\n");
    CHECK(status_of(c.answer()) == 200);
  }
}

TEST_CASE("an error in an imported file names the file once, with the line") {
  const Served lab;
  const auto check = [&](const char* name, const char* toml) {
    const Json asked = {{"name", name}, {"toml", toml}};
    const Json j = Json::parse(test::body_of(
        lab.ask("POST /api/check", lab.own() + "Content-Type: application/json\r\n", asked.dump())));
    CHECK(j["ok"] == false);
    return j["where"].get<std::string>();
  };
  CHECK(check("bad1.toml", "title = 'x'\nseed =\n") == "bad1.toml:2");
  CHECK(check("bad2.toml", "[[swarm]]\ncount = -1\n") == "bad2.toml:2: swarm[0].count");
  CHECK(check("../../bad3.toml", "seed =\n") == "bad3.toml:1");
  CHECK(check("", "seed =\n") == "file:1");
}

TEST_CASE("currents of a field map must be a list of numbers, and no job starts with other values") {
  const Served lab;
  fs::create_directories(lab.folder() / "rigs");
  write_file(lab.folder() / "rigs/a.toml", "");
  for (const Json& current : {Json(" "), Json("0.5,1"), Json({"0.5", ""}), Json({"a"}), Json({"0.5 T"}),
                              Json({"nan"}), Json({"--json"})}) {
    INFO(current.dump());
    const Json asked = {{"kind", "field-map"}, {"values", {{"rig", "rigs/a.toml"}, {"current", current}}}};
    const std::string a =
        lab.ask("POST /api/jobs", lab.own() + "Content-Type: application/json\r\n", asked.dump());
    CHECK(status_of(a) == 422);
    CHECK(Json::parse(test::body_of(a))["where"] == "current");
  }
  CHECK(Json::parse(test::body_of(lab.get("/api/jobs"))).empty());
}

TEST_CASE("S1: bound to the loopback address only") {
  const Served lab;
  int listening = 0;
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream in(table);
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      std::string number, local, remote, state;
      words >> number >> local >> remote >> state;
      if (state != "0A" || !local.ends_with(fmt::format(":{:04X}", lab.port))) continue;
      ++listening;
      CHECK(local.substr(0, local.find(':')) == "0100007F");
    }
  }
  CHECK(listening == 1);
}

TEST_CASE("S2: without the token every path is refused, also files and the WebSocket") {
  const Served lab;
  const std::string host = fmt::format("Host: 127.0.0.1:{0}\r\nOrigin: http://127.0.0.1:{0}\r\n", lab.port);
  for (const char* line :
       {"GET /", "GET /index.html", "GET /app.js", "GET /app.css", "GET /api/about", "GET /api/scenes",
        "GET /api/runs", "GET /runs/x/report.html", "POST /api/check", "POST /api/upload",
        "DELETE /api/jobs/1", "HEAD /", "OPTIONS /", "PUT /", "GET /nowhere"}) {
    INFO(line);
    CHECK(status_of(lab.ask(line, host + "Content-Type: application/json\r\n")) == 401);
  }
  CHECK(status_of(lab.ask("GET /ws", host + kUpgrade + "Sec-WebSocket-Protocol: faba.1\r\n")) == 401);
  CHECK(status_of(lab.ask("GET /api/about?token=" + std::string(32, '0'), host)) == 401);
}

TEST_CASE("S3: other hosts are refused") {
  const Served lab;
  const std::string cookie = fmt::format("Cookie: faba-{}={}\r\n", lab.port, lab.token);
  const std::string right = fmt::format("Host: 127.0.0.1:{}\r\n", lab.port);
  CHECK(status_of(lab.ask("GET /api/about", right + cookie)) == 200);
  for (const std::string& host :
       {std::string("Host: evil.example\r\n"), fmt::format("Host: 127.0.0.1.evil.example:{}\r\n", lab.port),
        std::string(), right + right, right + "Host: evil.example\r\n", std::string("Host: 127.0.0.1\r\n")}) {
    INFO(host);
    CHECK(status_of(lab.ask("GET /api/about", host + cookie)) == 403);
  }
}

TEST_CASE("S4: WebSockets of other pages are refused") {
  const Served lab;
  const std::string with =
      fmt::format("Host: 127.0.0.1:{0}\r\nCookie: faba-{0}={1}\r\n", lab.port, lab.token) + kUpgrade;
  const std::string protocol = "Sec-WebSocket-Protocol: faba.1\r\n";
  for (const std::string& origin :
       {fmt::format("Origin: http://127.0.0.1:{}\r\n", lab.port + 1), std::string("Origin: null\r\n"),
        std::string("Origin: http://1.2.3.4\r\n"), fmt::format("Origin: http://1.2.3.4:{}\r\n", lab.port),
        std::string("Origin: file://\r\n"), std::string()}) {
    INFO(origin);
    CHECK(status_of(lab.ask("GET /ws", with + protocol + origin)) == 403);
  }
  const std::string own = fmt::format("Origin: http://127.0.0.1:{}\r\n", lab.port);
  CHECK(status_of(lab.ask("GET /ws", with + own)) == 400);  // missing or unknown protocol
  CHECK(status_of(lab.ask("GET /ws", with + own + "Sec-WebSocket-Protocol: faba.9\r\n")) == 400);
  const std::string open = lab.ask("GET /ws", with + own + protocol);
  CHECK(status_of(open) == 101);
  CHECK(open.find("Sec-WebSocket-Protocol: faba.1") != std::string::npos);
}

TEST_CASE("S5: content types of HTML forms are refused") {
  const Served lab;
  for (const char* type :
       {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"}) {
    CHECK(status_of(lab.ask("POST /api/check", lab.own() + "Content-Type: " + type + "\r\n", "{}")) == 415);
    CHECK(status_of(lab.ask("POST /api/upload?name=x", lab.own() + "Content-Type: " + type + "\r\n", "{}")) ==
          415);
  }
}

TEST_CASE("S6: only runs and scenes of the workspace can be read") {
  const Served lab;
  fs::create_directories(lab.folder() / "runs/a");
  write_file(lab.folder() / "runs/a/series.csv", "frame\n");
  fs::create_symlink(lab.folder() / "secret.txt", lab.folder() / "runs/a/link.csv");
  fs::create_symlink("/etc", lab.folder() / "runs/etc");
  CHECK(status_of(lab.get("/api/runs/a/series.csv")) == 200);
  CHECK(status_of(lab.get("/api/runs/a/link.csv")) == 200);  // within the workspace
  for (const char* path :
       {"/api/runs/../secret.txt", "/api/runs/%2e%2e/secret.txt", "/api/runs/etc/passwd", "/runs/etc/passwd",
        "/api/runs/a/..%2f..%2fsecret.txt", "/api/runs/a/%00", "/runs/../secret.txt", "/../secret.txt",
        "/api/scenes/..%2f..%2fsecret", "/api/uploads/..%2fsecret.txt", "//etc/passwd", "/etc/passwd"}) {
    INFO(path);
    const std::string a = lab.get(path);
    CHECK(status_of(a) >= 400);
    CHECK(status_of(a) < 500);
    CHECK(a.find("confidential content") == std::string::npos);
    CHECK(a.find("root:") == std::string::npos);
  }
  CHECK(status_of(lab.get("/api/runs/" + std::string(7000, 'a') + "/x")) >= 400);
  const int longer = status_of(lab.get("/" + std::string(60000, 'a')));
  CHECK((longer == 431 || longer == 400));
}

TEST_CASE("a run with a damaged manifest does not hide the other runs") {
  const Served lab;
  const std::pair<const char*, const char*> manifests[] = {
      {"good", R"({"title": "Good", "frames": 3, "seed": 1})"},
      {"frames", R"({"frames": "x"})"},
      {"title", R"({"title": 3})"},
      {"list", "[1]"},
      {"half", R"({"title": "Ha)"}};
  for (const auto& [name, manifest] : manifests) {
    fs::create_directories(lab.folder() / "runs" / name);
    write_file(lab.folder() / "runs" / name / "manifest.json", manifest);
    write_file(lab.folder() / "runs" / name / "scenario.toml", "title = 'x'\n");
  }
  const std::string a = lab.get("/api/runs");
  CHECK(status_of(a) == 200);
  const Json runs = Json::parse(a.substr(a.find("\r\n\r\n")));
  REQUIRE(runs.size() == 1);
  CHECK(runs[0]["name"] == "good");
}

TEST_CASE("S7: slow, many and large requests are limited, and other clients are served") {
  const Served lab;
  const std::size_t before = resident();
  // Ten thousand incomplete requests, 500 at the same time; connections above the limit are closed at once.
  for (int round = 0; round < 20; ++round) {
    std::vector<std::unique_ptr<RawClient>> slow;
    for (int i = 0; i < 500; ++i) {
      slow.push_back(std::make_unique<RawClient>(lab.port));
      slow.back()->send("GET / HTTP/1.1\r\nX: ");
    }
    CHECK(slow.back()->is_closed());
  }
  // Connections become available when those clients have disconnected.
  int served = 0;
  for (int i = 0; i < 200 && served != 200; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(25)))
    served = status_of(lab.get("/api/about"));
  CHECK(served == 200);
  // A body with a declared length of 1 GiB is refused before it is read.
  CHECK(status_of(lab.ask(
            "POST /api/check",
            lab.own() + "Content-Type: application/json\r\nX: y\r\nContent-Length: 1073741824\r\nZ: ")) >=
        400);
  RawClient big(lab.port);
  big.send("POST /api/check HTTP/1.1\r\n" + lab.own() +
           "Content-Type: application/json\r\nContent-Length: 1073741824\r\n\r\n");
  CHECK(status_of(big.answer()) == 413);
  // A WebSocket frame with a declared length of 1 GiB closes the socket.
  RawClient socket(lab.port);
  socket.send("GET /ws HTTP/1.1\r\n" + lab.own() + kUpgrade + "Sec-WebSocket-Protocol: faba.1\r\n\r\n");
  CHECK(status_of(socket.answer()) == 101);
  socket.send(std::string("\x81\xff\x00\x00\x00\x00\x40\x00\x00\x00mask", 14));
  CHECK(socket.is_closed());
  // Compression is not accepted, so decompression bombs are impossible.
  RawClient squeezed(lab.port);
  squeezed.send("GET /ws HTTP/1.1\r\n" + lab.own() + kUpgrade +
                "Sec-WebSocket-Protocol: faba.1\r\nSec-WebSocket-Extensions: permessage-deflate\r\n\r\n");
  CHECK(squeezed.answer().find("permessage-deflate") == std::string::npos);
  CHECK(status_of(lab.get("/api/about")) == 200);
  CHECK(resident() < before + (64u << 20));
}

TEST_CASE("S8: only the user can read the token") {
  const Served lab;
  CHECK(lab.token.size() == 32);
  CHECK(lab.door_mode == (fs::perms::owner_read | fs::perms::owner_write));
  CHECK(lab.folder_mode == fs::perms::owner_all);
  const std::string page = lab.get("/");
  CHECK(page.find(lab.token) == std::string::npos);
  CHECK(page.find("Referrer-Policy: no-referrer") != std::string::npos);
}

TEST_CASE("S9: every response has security headers") {
  const Served lab;
  fs::create_directories(lab.folder() / "runs/a");
  write_file(lab.folder() / "runs/a/report.html", "<p>");
  for (const std::string& a : {lab.get("/"), lab.get("/api/about"), lab.get("/nowhere"),
                               lab.get("/runs/a/report.html"), lab.ask("GET /", "Host: evil\r\n")}) {
    CHECK(a.find("Cross-Origin-Resource-Policy: same-origin\r\n") != std::string::npos);
    CHECK(a.find("X-Content-Type-Options: nosniff\r\n") != std::string::npos);
    CHECK(a.find("Content-Security-Policy: default-src 'none'") != std::string::npos);
    CHECK(a.find("script-src 'unsafe") == std::string::npos);
  }
  // A report has inline style, but no scripts.
  const std::string report = lab.get("/runs/a/report.html");
  CHECK(report.find("style-src 'unsafe-inline'") != std::string::npos);
  CHECK(report.find("script-src") == std::string::npos);
}

TEST_CASE("a port in use and an invalid scene are errors before the server starts") {
  const Served lab;
  LabOptions o;
  o.workspace = lab.folder();
  o.port = lab.port;
  o.ready = [](const std::string&, const fs::path&) { FAIL("served"); };
  CHECK_THROWS_WITH_AS(serve_lab(o), doctest::Contains("--port"), const Error&);
  o.port = 0;
  write_file(lab.folder() / "wrong.toml", "swarm = 3\n");
  o.scene = lab.folder() / "wrong.toml";
  CHECK_THROWS_AS(serve_lab(o), const Error&);
  // An error that is found only when the run is constructed.
  write_file(lab.folder() / "full.toml",
             "[arena]\ntype = 'box'\nsize_px = [40, 25]\n[[swarm]]\ncount = 100000\n");
  o.scene = lab.folder() / "full.toml";
  CHECK_THROWS_WITH_AS(serve_lab(o), doctest::Contains("at most 1000 pixels"), const Error&);
}
