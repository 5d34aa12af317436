#include "client/watch/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/watch/chart.h"

namespace shaken::client {
namespace {

constexpr int kMostChartLines = 14;
constexpr int kFewestChartLines = 5;

std::string bar_line(const LiveJob& job, const Console& console) {
  if (job.draws_film) {
    return fmt::format("{}  {} {}  {} simulated  {}", console.painted(Colour::kBold, short_id(job.id)),
                       console.painted(Colour::kYellow, bar_text(job.drawn, 16)),
                       console.painted(Colour::kYellow, film_text(job)), duration_text(job.sim_time), job.label);
  }
  return fmt::format("{}  {} {:5.1f} %  {} of {}  {:.3g} sim-s/s  ETA {} ({})  {}",
                     console.painted(Colour::kBold, short_id(job.id)),
                     console.painted(Colour::kBlue, bar_text(job.fraction(), 16)), 100 * job.fraction(),
                     duration_text(job.sim_time), duration_text(job.sim_time_total), job.sim_rate,
                     duration_text(job.eta), clock_text(job.eta, utime_now()), job.label);
}

std::string numbers_line(const LiveJob& job, const Console& console) {
  std::string line;
  if (job.order) {  // spheres have none
    line = fmt::format("  S {}  mean {:.3f}", console.painted(Colour::kGreen, fmt::format("{:.3f}", *job.order)),
                       job.order_mean);
  }
  line += fmt::format("  N {}  overlap {:.2g} mm", job.n_rods, job.max_overlap);
  if (job.n_plus) line += fmt::format("  defects +{} −{}", *job.n_plus, *job.n_minus);
  if (job.observables) {
    const observables_t& o = *job.observables;
    line += fmt::format("  v_xy {:.2f}  v_z {:.2f} mm/s  n_z {:.3f}  hits/s of a rod: {}", o.rms_speed_xy_mm_s,
                        o.rms_speed_z_mm_s, o.rms_n_z, hits_text(job.hits.rates()));
  }
  return line;
}

std::string summary_line(const LiveJobs& jobs, const std::string& title, const Console& console) {
  Json counts = Json::object();
  double fraction = 0;
  for (const LiveJob& job : jobs.jobs()) {
    counts[job.state] = counts.value(job.state, 0) + 1;
    fraction += job.fraction() / static_cast<double>(jobs.jobs().size());
  }
  return fmt::format("{}  {} {:3.0f} %  {}", console.painted(Colour::kBold, title),
                     console.painted(Colour::kBlue, bar_text(fraction, 16)), 100 * fraction, counts_text(counts));
}

}  // namespace

std::vector<std::string> watch_screen(const LiveJobs& jobs, const std::string& title, const std::string& note,
                                      const Console& console) {
  std::vector<const LiveJob*> running;
  for (const LiveJob& job : jobs.jobs()) {
    if (job.is_running()) running.push_back(&job);
  }
  std::vector<std::string> lines{summary_line(jobs, title, console), ""};

  // Every running job gets its two lines first, then charts share what is left.
  const int room = console.height - 1 - static_cast<int>(lines.size());
  const int n_shown = std::clamp(room / 2, 0, static_cast<int>(running.size()));
  const int spare = room - 2 * n_shown;
  const int n_charts = std::min(n_shown, spare / kFewestChartLines);
  const int chart_lines = n_charts > 0 ? std::min(kMostChartLines, spare / n_charts) : 0;
  for (int i = 0; i < n_shown; ++i) {
    const LiveJob& job = *running[static_cast<std::size_t>(i)];
    lines.push_back(bar_line(job, console));
    lines.push_back(numbers_line(job, console));
    if (i >= n_charts) continue;
    for (std::string& line : order_chart(job, std::min(console.width, 110), chart_lines)) {
      lines.push_back(std::move(line));
    }
  }
  const int n_hidden = static_cast<int>(running.size()) - n_shown;
  lines.push_back(
      console.painted(Colour::kDim, (n_hidden > 0 ? fmt::format("{} more running; ", n_hidden) : "") + note));
  for (std::string& line : lines) line = fitted(line, static_cast<std::size_t>(std::max(1, console.width)));
  if (static_cast<int>(lines.size()) > console.height)
    lines.resize(static_cast<std::size_t>(std::max(1, console.height)));
  return lines;
}

std::vector<std::string> order_chart(const LiveJob& job, int width, int height) {
  const History& history = job.order_history;
  const double end = std::max(job.sim_time, 1e-3), begin = history.times().empty() ? 0 : history.times().front();
  const bool is_whole = begin < end / 20;
  const ChartFrame frame{.width = width,
                         .height = height,
                         .x_min = is_whole ? 0 : std::min(begin, 0.99 * end),
                         .x_max = end,
                         .x_unit = is_whole ? "s   S(t)" : "s   S(t), live only"};
  return line_chart(history.times(), history.values(), frame);
}

std::string hits_text(const HitRates& rates) {
  return fmt::format("rods {} base {} lid {}", number_text(rates.rod), number_text(rates.base), number_text(rates.lid));
}

std::string film_text(const LiveJob& job) {
  return fmt::format("drawing the film {:.0f} %", std::floor(100 * job.drawn)) +
         (job.film_eta >= 0 ? ", ETA " + duration_text(job.film_eta) : "");
}

std::string watch_line(const LiveJob& job) {
  std::string line = fmt::format("{} {}", short_id(job.id), job.draws_film ? film_text(job) : job.state);
  if (job.sim_time_total > 0) {
    line += fmt::format(" {:5.1f} %  t {:.3f}/{:.3f} s", 100 * job.fraction(), job.sim_time, job.sim_time_total);
  }
  if (job.result) {
    line += fmt::format("  mean S {}{:.3f} ({})", mark_of(job.result->steadiness), job.result->value,
                        word_of(job.result->steadiness));
  } else if (job.order) {
    line += fmt::format("  S {:.3f}", *job.order);
  }
  if (job.order && job.is_running()) line += fmt::format(" (mean {:.3f})", job.order_mean);
  if (job.is_running() && !job.draws_film)
    line += fmt::format("  {:.3g} sim-s/s  ETA {}", job.sim_rate, duration_text(job.eta));
  if (job.sim_time > 0) line += fmt::format("  overlap {:.2g} mm", job.max_overlap);
  if (job.observables) {
    line += fmt::format("  hits {}/{}/{}", job.observables->collisions_rod_rod, job.observables->collisions_rod_base,
                        job.observables->collisions_rod_lid);
  }
  if (job.n_plus) line += fmt::format("  defects +{} -{}", *job.n_plus, *job.n_minus);
  if (job.lost() > 0) line += fmt::format("  {} messages lost", job.lost());
  return line + (job.label.empty() ? "" : "  " + job.label) + (job.reason.empty() ? "" : "  " + job.reason);
}

}  // namespace shaken::client
