// Requests for the frames of videos: src/server/api/videos.cpp.
#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "core/file.h"
#include "server/api/api.h"
#include "server/videos/open_videos.h"
#include "tests/temporary_folder.h"
#include "vision/files/video_writer.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

constexpr int kWidth = 64, kHeight = 48, kFrames = 25;

// Frame k is uniform with the grey value 4 k.
void record(const fs::path& path, int frames = kFrames) {
  VideoWriter writer(path.string() + ".part", VideoFormat::lossless_avi, kWidth, kHeight, 10, 0,
                     VideoPixels::grey8);
  for (int k = 0; k < frames; ++k) writer.write(Gray8(kWidth, kHeight, std::uint8_t(4 * k)));
  writer.finish(path);
}

// The first half of a recording of noise, whose frames are larger than the header.
std::string truncated_recording(const fs::path& path) {
  VideoWriter writer(path.string() + ".part", VideoFormat::lossless_avi, kWidth, kHeight, 10, 0,
                     VideoPixels::grey8);
  std::uint32_t noise = 1;
  for (int k = 0; k < kFrames; ++k) {
    Gray8 frame(kWidth, kHeight);
    for (std::uint8_t& v : frame.px) v = std::uint8_t((noise = 1664525 * noise + 1013904223) >> 24);
    writer.write(frame);
  }
  writer.finish(path);
  const std::string complete = read_file(path);
  return complete.substr(0, complete.size() / 2);
}

class VideoLab {
 public:
  VideoLab() : folder_("videos"), workspace_(path(), path() / "scenes"), jobs_(FABA_PROGRAM, path(), [] {}) {
    fs::create_directories(path() / "pictures");
    record(path() / "a.avi");
    write_file(path() / "empty.avi", "");
    write_file(path() / "notes.avi", "These are notes.\n");
    write_file(path() / "short.avi", truncated_recording(path() / "noise.avi"));
  }
  WebResponse get(const std::string& what, std::map<std::string, std::string> query) {
    return api_.answer({.method = "GET",
                        .path = "/api/videos/" + what,
                        .query = std::move(query),
                        .body = {},
                        .upload = {}});
  }
  Json json(const std::string& what, std::map<std::string, std::string> query) {
    return Json::parse(get(what, std::move(query)).body);
  }
  const fs::path& path() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
  Workspace workspace_;
  JobList jobs_;
  Api api_{workspace_, jobs_, path() / "pictures", {}, [](const Json&) {}};
};

struct SentFrame {
  double t_s = 0;
  std::uint32_t index = 0;
  std::uint16_t width = 0, height = 0;
  std::string pixels;
};

std::vector<SentFrame> decoded(const std::string& body) {
  std::vector<SentFrame> all;
  for (std::size_t at = 0; at < body.size();) {
    std::uint32_t length = 0;
    SentFrame f;
    std::memcpy(&length, &body[at], 4);
    std::memcpy(&f.t_s, &body[at + 4], 8);
    std::memcpy(&f.index, &body[at + 12], 4);
    std::memcpy(&f.width, &body[at + 16], 2);
    std::memcpy(&f.height, &body[at + 18], 2);
    f.pixels = body.substr(at + 20, length - 16);
    all.push_back(f);
    at += 4 + length;
  }
  return all;
}

}  // namespace

TEST_CASE("a video is described, and its end is found") {
  VideoLab lab;
  const Json about = lab.json("about", {{"file", "a.avi"}});
  CHECK(about["width"] == kWidth);
  CHECK(about["height"] == kHeight);
  CHECK(about["bits"] == 8);
  CHECK(about["fps"] == 10);
  CHECK(about["low"] == 0);
  CHECK(about["high"] == 255);
  CHECK(about["um_per_px"].is_null());
  CHECK(about["damage"] == "");
  const Json end = lab.json("end", {{"file", "a.avi"}});
  CHECK(end["frames"] == kFrames);
  CHECK(end["length_s"].get<double>() == doctest::Approx(2.5));
  const Json cut = lab.json("end", {{"file", "short.avi"}});
  INFO(cut.dump());
  REQUIRE(cut.contains("frames"));
  CHECK(cut["frames"].get<int>() < kFrames);
  CHECK(cut["damage"].get<std::string>().find("truncated") != std::string::npos);
}

TEST_CASE("frames are sent one after the other, from any time") {
  VideoLab lab;
  for (const int from : {7, 0, 20, 3, 4}) {
    INFO("from ", from);
    const std::string t = std::to_string(0.1 * from + 0.02);
    const auto frames = decoded(lab.get("frames", {{"file", "a.avi"}, {"from", t}, {"count", "6"}}).body);
    REQUIRE(frames.size() == std::size_t(std::min(6, kFrames - from)));
    for (std::size_t k = 0; k < frames.size(); ++k) {
      CHECK(frames[k].t_s == doctest::Approx(0.1 * (from + int(k))));
      CHECK(frames[k].index == unsigned(from) + k);
      CHECK(frames[k].width == kWidth);
      CHECK(frames[k].pixels == std::string(kWidth * kHeight, char(4 * (from + int(k)))));
    }
  }
}

TEST_CASE("width, contrast and a frame by its number") {
  VideoLab lab;
  const auto small = decoded(
      lab.get("frames", {{"file", "a.avi"}, {"from", "1"}, {"width", "32"}, {"low", "0"}, {"high", "80"}})
          .body);
  REQUIRE(small.size() == 1);
  CHECK(small[0].width == 32);
  CHECK(small[0].height == 24);
  CHECK(std::uint8_t(small[0].pixels[0]) == 128);  // 40 of 80
  CHECK(lab.get("frame", {{"file", "a.avi"}, {"index", "3"}}).body.starts_with("\x89PNG"));
  const Json h = lab.json("histogram", {{"file", "a.avi"}, {"index", "3"}});
  CHECK(h["least"] == 12);
  CHECK(h["most"] == 12);
  CHECK(h["counts"] == Json{kWidth * kHeight});
  const WebResponse picture = lab.get("thumbnail.png", {{"file", "a.avi"}});
  CHECK(read_file(picture.file).starts_with("\x89PNG"));
}

TEST_CASE("the flow to the next frame, and the edge of a drop") {
  VideoLab lab;
  // A bright disc moves to the right and up, on a grey background.
  VideoWriter writer(lab.path() / "disc.part", VideoFormat::lossless_avi, 200, 160, 10, 0,
                     VideoPixels::grey8);
  for (int k = 0; k < 3; ++k) {
    Gray8 frame(200, 160, 90);
    for (int row = 0; row < 160; ++row)
      for (int col = 0; col < 200; ++col) {
        const double d = std::hypot(col - 100 - k, row - 80 + k) - 40;
        frame.at(col, row) = std::uint8_t(90 + 110 / (1 + std::exp(d / 3)));
      }
    writer.write(frame);
  }
  writer.finish(lab.path() / "disc.avi");
  const Json flow = lab.json("flow", {{"file", "disc.avi"}, {"t", "0.1"}});
  CHECK(flow["t_s"].get<double>() == doctest::Approx(0.1));
  REQUIRE(flow["arrows"].size() > 4);
  double u = 0, v = 0, longest = 0, from_edge = 0;
  for (const Json& arrow : flow["arrows"]) {
    const double length = std::hypot(arrow[2].get<double>(), arrow[3].get<double>());
    if (length > longest) {
      longest = length;
      from_edge = std::fabs(std::hypot(arrow[0].get<double>() - 101, arrow[1].get<double>() - 79) - 40);
    }
    u += arrow[2].get<double>();
    v += arrow[3].get<double>();
  }
  // The grey level changes only at the edge of the disc, from 10 to 90 % within 2 x 3 ln 9 px.
  CHECK(from_edge < 6 * std::log(9.0));
  CHECK(u > 0);
  CHECK(v < 0);  // up
  CHECK(lab.json("flow", {{"file", "disc.avi"}, {"t", "9"}})["arrows"].empty());
  const Json edge = lab.json("edge", {{"file", "disc.avi"}, {"t", "0.2"}});
  CHECK(edge["center_px"][0].get<double>() == doctest::Approx(102).epsilon(0.03));
  CHECK(edge["center_px"][1].get<double>() == doctest::Approx(78).epsilon(0.03));
  CHECK(edge["radius_px"].get<double>() == doctest::Approx(40).epsilon(0.06));
}

TEST_CASE("what is not a video is refused with its name in the workspace and the reason") {
  VideoLab lab;
  for (const char* file : {"empty.avi", "notes.avi"}) {
    for (const char* request : {"about", "frames", "frame", "thumbnail.png"}) {
      INFO(file, " ", request);
      const WebResponse r = lab.get(request, {{"file", file}});
      CHECK(r.status == 404);
      CHECK(Json::parse(r.body)["where"] == file);
      CHECK(Json::parse(r.body)["what"].get<std::string>().size() > 5);
      CHECK(r.body.find(lab.path().string()) == std::string::npos);
    }
  }
  CHECK(lab.get("frame", {{"file", "../a.avi"}}).status == 422);
  CHECK(lab.get("frame", {{"file", "/etc/passwd"}}).status != 200);
  CHECK(lab.get("frame", {{"file", "absent.avi"}}).status == 404);
  CHECK(lab.get("frame", {}).status == 422);
  CHECK(lab.json("frame", {{"file", "a.avi"}, {"t", "soon"}})["where"] == "t");
  CHECK(lab.get("frame", {{"file", "a.avi"}, {"width", "1e9"}}).status == 422);
}

TEST_CASE("a video that has changed is opened again, and several threads may read") {
  VideoLab lab;
  REQUIRE(decoded(lab.get("frames", {{"file", "a.avi"}, {"from", "99"}}).body)[0].index == kFrames - 1);
  record(lab.path() / "a.avi", 5);
  CHECK(decoded(lab.get("frames", {{"file", "a.avi"}, {"from", "99"}}).body)[0].index == 4);
  record(lab.path() / "a.avi");

  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int thread = 0; thread < 4; ++thread)
    threads.emplace_back([&, thread] {
      for (int k = 0; k < 20; ++k) {
        const int at = (7 * k + 5 * thread) % kFrames;
        const auto f =
            decoded(lab.get("frames", {{"file", "a.avi"}, {"from", std::to_string(0.1 * at + 0.01)}}).body);
        wrong += f.size() != 1 || std::uint8_t(f[0].pixels[0]) != 4 * at;
      }
    });
  for (std::thread& t : threads) t.join();
  CHECK(wrong == 0);
}

TEST_CASE("the scale of a picture is found in the OME-XML file beside it") {
  VideoLab lab;
  // A TIFF of one pixel without a description.
  const std::string tiff(
      "II*\0\x08\0\0\0\x07\0"
      "\0\x01\x03\0\x01\0\0\0\x01\0\0\0\x01\x01\x03\0\x01\0\0\0\x01\0\0\0"
      "\x02\x01\x03\0\x01\0\0\0\x08\0\0\0\x06\x01\x03\0\x01\0\0\0\x01\0\0\0"
      "\x11\x01\x04\0\x01\0\0\0\x62\0\0\0\x16\x01\x03\0\x01\0\0\0\x01\0\0\0"
      "\x17\x01\x04\0\x01\0\0\0\x01\0\0\0\0\0\0\0x",
      99);
  write_file(lab.path() / "c.tif", tiff);
  write_file(lab.path() / "c.companion.ome", "<OME><Pixels PhysicalSizeX='0.4' TimeIncrement='0.5'/></OME>");
  const Json about = lab.json("about", {{"file", "c.tif"}});
  INFO(about.dump());
  CHECK(about["um_per_px"] == 0.4);
}

TEST_CASE("only some videos stay open") {
  VideoLab lab;
  OpenVideos videos;
  VideoFrames* first = nullptr;
  videos.with(lab.path() / "a.avi", [&](VideoFrames& v) { first = &v; });
  videos.with(lab.path() / "a.avi", [&](VideoFrames& v) { CHECK(first == &v); });
  for (std::size_t k = 0; k < 2 * OpenVideos::kMostVideos; ++k) {
    const fs::path copy = lab.path() / ("copy" + std::to_string(k) + ".avi");
    fs::copy_file(lab.path() / "a.avi", copy);
    videos.with(copy, [](VideoFrames& v) { v.at(1); });
    CHECK(videos.size() <= OpenVideos::kMostVideos);
  }
}
