// SPDX-License-Identifier: MIT
#include "lattice/scene/units.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/toml_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "lattice/scene/scene.h"
#include "lattice/scene/study/sweep.h"
#include "lattice/scene/terrain.h"
#include "lattice/text/digits.h"
#include "tests/support/refusal.h"

namespace gatewalk::lattice {
namespace {

using test::scene_refusal;

KeyInfo key_of_scene(const Scene& scene, const std::string& key) {
  for (const KeyInfo& k : describe(scene))
    if (k.key == key) return k;
  throw std::runtime_error(key);
}

TEST(Units, OfAKeyTakePrefixes) {
  const auto power = [](const char* given, const char* key) {
    const auto unit = unit_of(given, key);
    return unit ? std::to_string(unit->power) + " " + unit->shown : "none";
  };
  EXPECT_EQ(power("body.radius_m", "body.radius_m"), "0 m");
  EXPECT_EQ(power("body.radius_cm", "body.radius_m"), "-2 cm");
  EXPECT_EQ(power("body.mass_kg", "body.mass_kg"), "0 kg");
  EXPECT_EQ(power("body.mass_g", "body.mass_kg"), "-3 g");
  EXPECT_EQ(power("body.mass_mg", "body.mass_kg"), "-6 mg");
  EXPECT_EQ(power("beams.damping_uNms_per_rad", "beams.damping_Nms_per_rad"), "-6 µN m s/rad");
  EXPECT_EQ(power("forces.drag_mNs_per_m", "forces.drag_Ns_per_m"), "-3 mN s/m");
  EXPECT_EQ(power("start.vy_cm_per_s", "start.vy_m_per_s"), "-2 cm/s");
  EXPECT_EQ(power("forces.random_rate_kHz", "forces.random_rate_Hz"), "3 kHz");
  EXPECT_EQ(power("forces.propulsion_cN", "forces.propulsion_N"), "none");
  EXPECT_EQ(power("body.radius_inch", "body.radius_m"), "none");
  EXPECT_EQ(power("contact.restitution", "contact.restitution"), "0 ");
  EXPECT_EQ(power("contact.restitution_m", "contact.restitution"), "none");
}

TEST(Units, ShiftTheDecimalPointAndNothingElse) {
  const KeyUnit cm{-2, "cm"}, kilo{3, "km"};
  EXPECT_EQ(in_own_unit(6.1, cm), 0.061);
  EXPECT_EQ(in_own_unit(8.2, cm), 0.082);
  EXPECT_NE(8.2 * 1e-2, 0.082);  // the result of a product
  EXPECT_EQ(in_own_unit(0.1, {-3, "mm"}), 1e-4);
  EXPECT_EQ(in_own_unit(-1.5e-7, kilo), -1.5e-4);
  EXPECT_EQ(in_own_unit(1e300, {3, "km"}), 1e303);
  EXPECT_EQ(in_own_unit(0.0, cm), 0.0);
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> whole(1, 999'999'999'999'999);
  for (int i = 0; i < 2000; ++i) {  // decimals of up to 15 digits
    const std::string digits = std::to_string(whole(random) >> (i % 40));
    const double given = std::stod(digits + "e-9");
    ASSERT_EQ(in_own_unit(given, cm), std::stod(digits + "e-11")) << digits;
    ASSERT_EQ(in_given_unit(given, cm), std::stod(digits + "e-7")) << digits;
  }
}

TEST(Units, SpellTheSameScene) {
  const Scene metres = parse_scene(R"(
body = { mass_kg = 0.09, radius_m = 0.061 }
beams = { length_m = 0.123, stiffness_left_Nm_per_rad = 0.0153, damping_Nms_per_rad = 2.7e-5 }
forces = { propulsion_N = 0.25, random_rate_Hz = 10, drag_Ns_per_m = 0.71 }
run = { time_limit_s = 20.5 }
start = { vy_m_per_s = 0.123 }
bins = { EN_d_m = [-0.01, 0, 0.023], RD_vy_m_per_s = [0, 0.37] }
)",
                                   "m.toml");
  const Scene others = parse_scene(R"(
body = { mass_g = 90, radius_cm = 6.1 }
beams = { length_mm = 123, stiffness_left_mNm_per_rad = 15.3, damping_uNms_per_rad = 27 }
forces = { propulsion_mN = 250, random_rate_kHz = 0.01, drag_mNs_per_m = 710 }
run = { time_limit_ms = 20500 }
start = { vy_cm_per_s = 12.3 }
bins = { EN_d_cm = [-1, 0, 2.3], RD_vy_mm_per_s = [0, 370] }
)",
                                   "cm.toml");
  EXPECT_EQ(to_toml(others), to_toml(metres));
  const KeyInfo radius = key_of_scene(others, "body.radius_m");
  EXPECT_EQ(radius.value, "0.061");
  EXPECT_EQ(radius.unit, "m");
  EXPECT_EQ(radius.source, "cm.toml:2 (radius_cm = 6.1)");
  EXPECT_EQ(key_of_scene(metres, "body.radius_m").source, "m.toml:2");
  EXPECT_EQ(others.derived, metres.derived);
}

TEST(Units, AnOverrideReplacesTheQuantity) {
  const std::string text = "[body]\nradius_cm = 8\nmass_g = 250\n";
  EXPECT_EQ(parse_scene(text, "x.toml", {"body.radius_m=0.07"}).gate.body.radius, 0.07);
  EXPECT_EQ(parse_scene(text, "x.toml", {"body.radius_mm=70"}).gate.body.radius, 0.07);
  EXPECT_EQ(parse_scene(text, "x.toml", {"body.radius_m=1", "body.radius_cm=7"}).gate.body.radius,
            0.07);
  EXPECT_EQ(keys_set_by("body.radius_cm=7"), std::vector<std::string>{"body.radius_m"});
}

TEST(Units, TwoOfOneQuantityAreRefused) {
  EXPECT_EQ(scene_refusal("[body]\nradius_m = 0.08\nmass_kg = 1\nradius_cm = 8\n"),
            "bad.toml:4: body.radius_cm = 8 is the same quantity as body.radius_m = 0.08 "
            "(bad.toml:2): give one of them");
  EXPECT_EQ(scene_refusal("[bins]\nEN_d_m = [0, 1]\nEN_d_cm = [0, 1]\n"),
            "bad.toml:3: bins.EN_d_cm (an array) is the same quantity as bins.EN_d_m (an array) "
            "(bad.toml:2): give one of them");
  EXPECT_EQ(
      scene_refusal("[terrain]\nrandom = { s = 0.5 }\n[terrain.types.s.forces]\npropulsion_mN = 1\n"
                    "propulsion_N = 1\n"),
      "bad.toml:5: terrain.types.s.forces.propulsion_N = 1 is the same quantity as "
      "terrain.types.s.forces.propulsion_mN = 1 (bad.toml:4): give one of them");
  EXPECT_EQ(scene_refusal("[sweep]\nforces.random_N = 1\nforces.random_mN = [2, 3]\n"),
            "bad.toml:3: sweep.forces.random_mN is there twice, as forces.random_N before");
}

TEST(Units, ErrorsSpeakTheUserSpelling) {
  EXPECT_EQ(scene_refusal("[body]\nradius_inch = 3\n"),
            "bad.toml:2: unknown key body.radius_inch: body.radius_m may end in _km, _m, _cm, _mm, "
            "_um or _nm instead");
  EXPECT_EQ(scene_refusal("", {"forces.propulsion_lbf=3"}),
            "--set forces.propulsion_lbf=3: unknown key forces.propulsion_lbf: forces.propulsion_N "
            "may end in _kN, _N, _mN, _uN or _nN instead");
  EXPECT_EQ(scene_refusal("[body]\nradius_s = 3\n"),
            "bad.toml:2: unknown key body.radius_s: body.radius_m may end in _km, _m, _cm, _mm, "
            "_um or _nm instead");
  EXPECT_EQ(scene_refusal("[body]\nraduis_cm = 3\n"),
            "bad.toml:2: unknown key body.raduis_cm; the closest known key is body.radius_m");
  EXPECT_EQ(scene_refusal("[forces]\nrandom_mN = -3\n"),
            "bad.toml:2: forces.random_mN = -3 is not permitted: must lie in [0, 1e+103] mN");
  EXPECT_EQ(scene_refusal("[start]\nx_cm = 2501\n"),
            "bad.toml:2: start.x_cm = 2501 is not permitted: must lie in [-2500, 2500] cm");
  EXPECT_EQ(scene_refusal("[body]\nradius_cm = 4000\n[beams]\njoint_y_m = 30\n"),
            "bad.toml:2 (radius_cm = 4000): body.radius_m = 40 is not permitted: must be less than "
            "beams.joint_y_m = 30, or a body that enters at y = 0 is already in the beams");
  EXPECT_EQ(scene_refusal("[forces]\nrandom_rate = 3\n"),
            "bad.toml:2: unknown key forces.random_rate; the closest known key is "
            "forces.random_rate_Hz");
}

TEST(Units, OfTypesOfGates) {
  const Scene scene = parse_scene(
      "[terrain]\nrandom = { s = 0.5 }\n[terrain.types.s]\nforces.propulsion_mN = 6100\n", "x.toml",
      {"terrain.types.s.beams.mass_g=61"});
  ASSERT_EQ(scene.terrain->types.size(), 1u);
  const dynamics::GateParams gate = gate_of(scene, scene.terrain->types[0]);
  EXPECT_EQ(gate.forces.propulsion, 6.1);
  EXPECT_EQ(gate.beams.mass, 0.061);
  EXPECT_EQ(key_of_scene(scene, "terrain.types.s.forces.propulsion_N").source,
            "x.toml:4 (forces.propulsion_mN = 6100)");
}

TEST(Units, OfWhatIsVaried) {
  const auto axes = sweep_axes(parse_scene("[sweep]\nbody.radius_m = \"1:2:5\"\n", "x.toml").sweep,
                               {"body.radius_cm=100,200"});
  ASSERT_EQ(axes.size(), 1u);  // the override replaces the file's axis
  const auto points = sweep_points({TomlFile("", "x.toml"), {}, axes});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].scene.gate.body.radius, 2.0);
  EXPECT_THROW((void)sweep_axes({}, {"body.radius_cm=1,2", "body.radius_m=1,2"}), SceneError);
}

}  // namespace
}  // namespace gatewalk::lattice
