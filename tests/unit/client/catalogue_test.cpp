// SPDX-License-Identifier: MIT
// The catalogue that Python reads is that of the programs. To write it anew: SHAKEN_UPDATE_DOCS=1 and run these tests.
#include "client/catalogue.h"

#include <gtest/gtest.h>

#include "client/live/json.h"
#include "tests/support/generated_page.h"

namespace shaken::client {
namespace {

TEST(Catalogue, IsTheOneThatPythonReads) {
  const std::string file = SHAKEN_SOURCE_DIR "/python/shaken/catalogue.json";
  if (std::getenv("SHAKEN_UPDATE_DOCS") != nullptr) std::ofstream(file) << catalogue();
  EXPECT_TRUE(content_of(file) == catalogue()) << file << ": run this test with SHAKEN_UPDATE_DOCS=1";
}

TEST(Catalogue, SaysOfEveryQuantityWhatItIs) {
  const Json all = Json::parse(catalogue());
  std::size_t n_titles = 0;
  for (const char* section : {"keys", "style_keys", "observables", "arrays", "numbers", "effects"}) {
    for (const auto& [name, row] : all[section].items()) {
      EXPECT_FALSE(row["doc"].get<std::string>().empty()) << name;
      if (!row.contains("unit")) continue;
      const std::string unit = row["unit"], title = row["title"], symbol = row["symbol"];
      EXPECT_EQ(symbol.find('$'), std::string::npos) << name << ": figures set it in mathematics";
      EXPECT_FALSE(title.empty() && !symbol.empty()) << name << " has a symbol without a name";
      EXPECT_EQ(unit.empty(), row.value("of", "") == "plain number" && unit.empty()) << name << " has no unit";
      n_titles += title.empty() ? 0 : 1;
    }
  }
  EXPECT_GE(n_titles, 130U);
}

TEST(Catalogue, NamesAxesThatAreArraysWithoutAxes) {
  const Json arrays = Json::parse(catalogue())["arrays"];
  for (const auto& [name, row] : arrays.items()) {
    for (const Json& axis : row["axes"]) EXPECT_TRUE(arrays[axis.get<std::string>()]["axes"].empty()) << name;
  }
  EXPECT_EQ(arrays["/density/area_fraction"]["axes"], Json({"/density/time_s", "/density/y_mm", "/density/x_mm"}));
  EXPECT_EQ(arrays["/tilt/folded/v_along_mm_s"]["axes"], Json({"/tilt/folded/n_z"}));
  EXPECT_EQ(arrays["/defects/tracks/lasting/speed_plus_mm_s"]["axes"], Json({"/defects/tracks/span_s"}));
  EXPECT_EQ(arrays["/scattering/alpha_2"]["axes"], Json({"/scattering/lag_s"}));
  EXPECT_TRUE(arrays["/defects/list/charge"]["axes"].empty());
}

}  // namespace
}  // namespace shaken::client
