// SPDX-License-Identifier: MIT
#include "bench/accuracy/style.h"

#include <fmt/format.h>

#include <array>

#include "bench/picture.h"

namespace shaken::bench {
namespace {

constexpr std::array<const char*, 8> kColours{"#4477aa", "#ee6677", "#228833", "#aa3377",
                                              "#66ccee", "#ccbb44", "#bbbbbb", "#222222"};

}  // namespace

const char* colour(std::size_t k) { return kColours[k % kColours.size()]; }

std::string multiplot(const std::string& name, std::size_t panels) {
  const std::size_t columns = panels < 3 ? panels : (panels + 1) / 2;
  const std::size_t rows = (panels + columns - 1) / columns;
  const auto of_columns = [&](double share) { return share / static_cast<double>(columns); };
  const auto of_rows = [&](double share) { return share / static_cast<double>(rows); };
  std::string script = gnuplot_prologue(name, static_cast<int>(480 * columns), static_cast<int>(30 + 400 * rows));
  script += fmt::format(
      "set multiplot layout {},{} margins screen {:.4f},{:.4f},{:.4f},{:.4f} spacing screen {:.4f},{:.4f}\n", rows,
      columns, of_columns(0.24), 1 - of_columns(0.06), of_rows(0.16), 1 - of_rows(0.12), of_columns(0.24),
      of_rows(0.27));
  script +=
      "set logscale xy\nset format y '10^{%L}'\nset grid x y linetype 1 linecolor '#e2e2e2' linewidth 0.5\n"
      "set title offset 0,-0.5\nset ylabel offset 0.5,0\n";
  return script;
}

}  // namespace shaken::bench
