#include "client/live/live.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/live/target.h"
#include "proto/sequence.h"
#include "run/files/order_curve.h"

namespace shaken::client {

namespace {

/// Points of S(t) that are read of a run's files.
constexpr std::size_t kMostPastPoints = 300;

/// What the files of the run in `directory` know of the time before it was watched, unless they have been asked.
void add_past(LiveJob& job, const std::string& directory) {
  if (job.history_begin == job.order_history.times().front() || directory.empty()) return;
  if (const auto past = run::recorded_order({directory}, kMostPastPoints)) {
    job.order_history.begin_with(past->times, past->orders);
  }
  job.history_begin = job.order_history.times().front();
}

/// The numbers of a JOB object, unless a message has told newer ones.
void take_progress(LiveJob& job, const Json& answer) {
  const double time = progress_number(answer, "sim_time_s");
  if (std::isnan(time)) return;
  // The file is up to half a second older than a message.
  if (job.observables && job.observables->sim_time_s >= time) return;
  const auto take = [&answer](const char* key, double& value) {
    if (const double number = progress_number(answer, key); !std::isnan(number)) value = number;
  };
  job.sim_time = time;
  take("sim_time_total_s", job.sim_time_total);
  take("sim_rate", job.sim_rate);
  take("eta_s", job.eta);
  take("order_running_mean", job.order_mean);
  take("max_overlap_mm", job.max_overlap);
  if (const double n = progress_number(answer, "n_rods"); n > 0 && n < 1e9) job.n_rods = static_cast<int>(n);
  if (const double order = progress_number(answer, "order"); !std::isnan(order) && time > 0) {
    job.order = order;
    job.order_history.add(time, order);
  }
}

}  // namespace

void SequenceCounter::note(std::int64_t sequence) {
  if (last_) lost_ += proto::n_lost_between(*last_, sequence);
  last_ = sequence;
  ++received_;
}

void HitCounter::note(const observables_t& message) {
  constexpr double kFewest = 10'000;
  const bool goes_back = begin_ && begin_->sim_time_s >= message.sim_time_s;  // to a checkpoint
  if (goes_back) begin_ = message;
  const observables_t from = begin_.value_or(observables_t{});
  const double time = message.sim_time_s - from.sim_time_s;
  // Counts are what anybody has sent: differences of doubles cannot overflow.
  const auto n = [&](std::int64_t observables_t::*count) {
    return std::max(0.0, static_cast<double>(message.*count) - static_cast<double>(from.*count));
  };
  const double rod = 2 * n(&observables_t::collisions_rod_rod);  // each hits two rods
  const double base = n(&observables_t::collisions_rod_base), lid = n(&observables_t::collisions_rod_lid);
  if (!(time > 0) || message.n_rods <= 0 || (begin_ && rod + base + lid < kFewest)) return;
  const double scale = 1 / (time * message.n_rods);
  rates_ = {scale * rod, scale * base, scale * lid};
  begin_ = message;
}

void History::add(double time, double value) {
  static constexpr std::size_t kMostPoints = 4096;
  if (!times_.empty() && time < times_.back()) {
    times_.clear();
    values_.clear();
  }
  if (!times_.empty() && time == times_.back()) return;
  times_.push_back(time);
  values_.push_back(value);
  if (times_.size() < kMostPoints) return;
  for (std::vector<double>* array : {&times_, &values_}) {
    for (std::size_t i = 0; i < array->size() / 2; ++i) (*array)[i] = (*array)[2 * i];
    array->resize(array->size() / 2);
  }
}

void History::begin_with(const std::vector<double>& times, const std::vector<double>& values) {
  const History later = std::exchange(*this, {});
  for (std::size_t i = 0; i < times.size() && (later.times_.empty() || times[i] < later.times_.front()); ++i) {
    add(times[i], values[i]);
  }
  for (std::size_t i = 0; i < later.times_.size(); ++i) add(later.times_[i], later.values_[i]);
}

double LiveJob::fraction() const {
  if (state == "done") return 1.0;
  return sim_time_total > 0 ? std::clamp(sim_time / sim_time_total, 0.0, 1.0) : 0.0;
}

LiveJob* LiveJobs::find(const std::string& id) {
  const auto place = index_.find(id);
  return place == index_.end() ? nullptr : &jobs_[place->second];
}

void LiveJobs::note_api(const Json& answer) {
  const std::string id = answer.at("id").get<std::string>();
  const auto [place, is_new] = index_.try_emplace(id, jobs_.size());
  if (is_new) jobs_.emplace_back().id = id;
  LiveJob& job = jobs_[place->second];
  job.label = text_of(answer, "label");
  job.state = answer.at("state").get<std::string>();
  job.ended = has_ended(answer);
  job.reason = text_of(answer, "reason");
  const auto progress = answer.find("progress");
  job.draws_film = job.is_running() && progress != answer.end() && text_of(*progress, "state") == "rendering";
  // Numbers that are no numbers, and those of older workers, leave them as they were.
  const double drawn = progress_number(answer, "drawn"), film_eta = progress_number(answer, "eta_s");
  if (job.draws_film && drawn >= 0) job.drawn = std::min(drawn, 1.0);
  if (job.draws_film && !std::isnan(film_eta)) job.film_eta = film_eta;
  if (job.state == "done") job.sim_time = job.sim_time_total;
  if (job.state != "done") job.result.reset();  // it goes on again
  if (job.state == "done" && !job.result) job.result = mean_order(answer);
  take_progress(job, answer);
  if (job.is_running() && !job.order_history.times().empty()) add_past(job, text_of(answer, "directory"));
}

bool LiveJobs::contradicts(const job_t& message) const {
  const auto place = index_.find(message.job_id);
  return place != index_.end() && jobs_[place->second].state != message.state;
}

void LiveJobs::note(const observables_t& message) {
  LiveJob* job = find(message.job_id);
  if (job == nullptr) return;
  job->observables_counter.note(message.sequence);
  job->observables = message;
  job->hits.note(message);
  job->sim_time = message.sim_time_s;
  job->sim_time_total = message.sim_time_total_s;
  job->sim_rate = message.sim_rate;
  job->eta = message.eta_s;
  job->n_rods = message.n_rods;
  job->order = std::isfinite(message.order) ? std::optional(message.order) : std::nullopt;
  job->order_mean = message.order_running_mean;
  job->max_overlap = message.max_overlap_mm;
  if (job->order) job->order_history.add(message.sim_time_s, message.order);
}

void LiveJobs::note(const defects_t& message) {
  LiveJob* job = find(message.job_id);
  if (job == nullptr) return;
  job->defects_counter.note(message.sequence);
  const auto positive = [](double charge) { return charge > 0; };
  const auto n_plus = std::count_if(message.charge.begin(), message.charge.end(), positive);
  job->n_plus = static_cast<int>(n_plus);
  job->n_minus = static_cast<int>(message.charge.size()) - *job->n_plus;
  job->defects = message;
}

bool LiveJobs::all_ended() const {
  return std::all_of(jobs_.begin(), jobs_.end(), [](const LiveJob& job) { return job.ended; });
}

std::int64_t LiveJobs::received() const {
  std::int64_t n = 0;
  for (const LiveJob& job : jobs_) n += job.observables_counter.received() + job.defects_counter.received();
  return n;
}

std::int64_t LiveJobs::lost() const {
  std::int64_t n = 0;
  for (const LiveJob& job : jobs_) n += job.lost();
  return n;
}

}  // namespace shaken::client
