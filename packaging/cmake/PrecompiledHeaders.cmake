# Headers of other projects that most files read, read once: two fifths of a build's work are their text. A library says
# target_precompile_headers(NAME REUSE_FROM shaken_headers_...), and its files still include what they use: builds
# with CMAKE_DISABLE_PRECOMPILE_HEADERS, clang-tidy's among them, hold them to that.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cpp CONTENT "int main() {}\n")
set(SHAKEN_HEADERS <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <numeric>
  <optional> <random> <span> <sstream> <string> <string_view> <thread> <utility> <variant> <vector>
  <Eigen/Core> <Eigen/Geometry>)

# numbers: for what computes, or handles arrays
add_library(shaken_headers_numbers OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
target_link_libraries(shaken_headers_numbers PRIVATE shaken::options Eigen3::Eigen)
target_compile_options(shaken_headers_numbers PRIVATE ${SHAKEN_COMPUTES})
target_precompile_headers(shaken_headers_numbers PRIVATE ${SHAKEN_HEADERS})

# words: for what reads and writes JSON and text; it must link fmt::fmt, which changes what the preprocessor knows
if(NOT SHAKEN_ONLY_SIM)
  add_library(shaken_headers_words OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(shaken_headers_words PRIVATE shaken::options Eigen3::Eigen nlohmann_json::nlohmann_json fmt::fmt)
  target_precompile_headers(shaken_headers_words PRIVATE ${SHAKEN_HEADERS} <fmt/format.h> <nlohmann/json.hpp>)
endif()
