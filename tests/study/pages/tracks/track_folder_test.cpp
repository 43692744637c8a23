#include "study/pages/tracks/track_folder.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/file.h"
#include "core/table.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

// A result folder with tracks of different speeds.
void write_result(const std::filesystem::path& folder) {
  std::string csv = "track,frame,t_s,x_px,y_px,mass,snr\n";
  for (int n = 1; n <= 40; ++n)
    for (int i = 0; i < 30; ++i)
      csv += std::to_string(n) + "," + std::to_string(i) + "," + std::to_string(0.05 * i) + "," +
             std::to_string(n * 0.125 * i).substr(0, 5) + "," + std::to_string(10 * n) +
             ".000,1.5e+03,12.5\n";
  write_file(folder / track_files::kTracks, csv);
  write_file(folder / track_files::kSummary,
             R"({"frame_s": 0.05, "um_per_px": 0.5, "speed": {"interval_frames": 2}, "tracks": 40,
                 "stage": {"removed": false}, "track_quality": null})");
}
Document document(const std::string& toml) { return parse_toml(toml, "edits.toml"); }

}  // namespace

TEST_CASE("track folder: edits are data, and are read as they were written") {
  const test::TemporaryFolder temporary("tracks");
  write_result(temporary.path());
  const TrackFolder folder = read_track_folder(temporary.path());
  CHECK(folder.tracks.size() == 40);
  CHECK(folder.interval == 2);
  CHECK(*folder.um_per_px == 0.5);
  const TrackEdits e = read_track_edits(document("[[cut]]\nfeature = \"speed\"\nmin = 33.333333333333336\n"
                                                 "[[edit]]\naction = \"split\"\ntrack = 3\nframe = 10\n"
                                                 "[[edit]]\naction = \"join\"\ntrack = 3\nwith = 41\n"
                                                 "[[edit]]\naction = \"delete\"\ntrack = 40\n"),
                                        folder);
  write_file(temporary.path() / track_files::kEdits, to_toml(edits_document(e, folder)));
  const TrackEdits again = read_track_edits(temporary.path(), folder);
  CHECK(edits_document(again, folder) == edits_document(e, folder));
  CHECK(*again.cuts.front().min == 33.333333333333336);

  const EditedFolder edited = apply_edits(folder, again);
  write_file(temporary.path() / "edited.csv", edited_tracks_csv(folder, edited));
  const Table t = read_table(temporary.path() / "edited.csv");
  // n / 8 px per frame of 0.05 s: 2.5 n px/s, so that 14 to 39 remain.
  CHECK(t.size() == 26 * 30);
  CHECK(t.column("track").front() == 14);
  const Json j = edited_json(folder, edited);
  CHECK(j["tracks"] == 26);
  CHECK(j["edited_tracks"]["cut"] == 13);
  CHECK(j["edited_tracks"]["deleted"] == 1);
  CHECK(j["speed"]["mean_um_s"].get<double>() == doctest::Approx(0.5 * 2.5 * 26.5).epsilon(0.01));
  CHECK(track_features_csv(folder, edited).find("# cut: speed from 33.333333333333336") != std::string::npos);
}

TEST_CASE("track folder: without edits the rows are those of the measured table") {
  const test::TemporaryFolder temporary("tracks");
  write_result(temporary.path());
  const TrackFolder folder = read_track_folder(temporary.path());
  const std::string csv = edited_tracks_csv(folder, apply_edits(folder, {}));
  const std::string header = "track,frame,t_s,x_px,y_px,mass,snr\n";
  CHECK(csv.starts_with("# 40 of 40 tracks of tracks.csv, sha256 " + folder.sha256 + "\n" + header));
  CHECK(csv.find("\n40,29,1.450000,") != std::string::npos);
}

TEST_CASE("track folder: invalid edits are refused with their key") {
  const test::TemporaryFolder temporary("tracks");
  CHECK_THROWS_AS((void)read_track_folder(temporary.path()), Error);
  write_result(temporary.path());
  const TrackFolder folder = read_track_folder(temporary.path());
  for (const auto& [toml, place] :
       {std::pair{"[[cut]]\nfeature = \"colour\"\nmin = 1\n", "cut[0]"},
        {"[[cut]]\nfeature = \"speed\"\n", "cut[0]"},
        {"[[cut]]\nfeature = \"speed\"\nmin = 2\nmax = 1\n", "cut[0]"},
        {"[[cut]]\nfeature = \"speed\"\nmin = 2\n[[cut]]\nfeature = \"speed\"\nmax = 9\n", "cut[1]"},
        {"[[edit]]\naction = \"paint\"\ntrack = 1\n", "edit[0]"},
        {"sha256 = \"0123\"\n", "sha256"},
        {"colour = 1\n", "colour"}}) {
    CAPTURE(toml);
    try {
      (void)read_track_edits(document(toml), folder);
      FAIL("accepted");
    } catch (const Error& e) {
      CHECK(e.where().find(place) != std::string::npos);
    }
  }
}
