#include "study/pages/drop_report.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace faba;

TEST_CASE("drop report: exactly the documented fields, in order") {
  DropEdge edge;
  edge.centre_image = {258.5, -12.25};
  edge.radius_px = 161;
  edge.sd_centre_px = {0.5, 0.75};
  edge.sd_radius_px = 0.25;
  edge.arc_deg = 90;
  edge.inside_image = {3, 4};
  edge.image_width = 518;
  edge.image_height = 488;
  edge.support = 0.9;
  CHECK(
      drop_json(edge, {}).dump() ==
      R"({"center_px":[258.5,-12.25],"radius_px":161.0,"sd_px":{"x":0.5,"y":0.75,"radius":0.25},)"
      R"("arc_deg":90.0,"support":0.9,"edge_width_px":0.0,"out_of_round_px":0.0,"inside":[3.0,4.0],"image_size":[518,488],"um_per_px":null,"um_per_px_source":null,"quality":"good","warnings":[]})");
}

TEST_CASE("drop report: a picture without a drop gives a default circle and a reason") {
  const ProposedDrop drop = propose_drop(GrayF(200, 100), "grey.png");
  CHECK_FALSE(drop.found);
  CHECK_FALSE(drop.reason.empty());
  nlohmann::ordered_json j = drop_json(drop);
  j["reason"] = "";
  CHECK(j.dump() ==
        R"({"found":false,"reason":"","center_px":[99.5,49.5],"radius_px":40.0,"image_size":[200,100],)"
        R"("um_per_px":null,"um_per_px_source":null})");
}
