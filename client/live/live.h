#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <shaken/defects_t.hpp>
#include <shaken/job_t.hpp>
#include <shaken/observables_t.hpp>
#include <string>
#include <vector>

#include "base/job_state.h"
#include "client/live/json.h"
#include "client/live/target.h"

namespace shaken::client {

/// Counts the messages that a gap in their sequence numbers shows to be lost.
class SequenceCounter {
 public:
  void note(std::int64_t sequence);
  std::int64_t received() const { return received_; }
  std::int64_t lost() const { return lost_; }

 private:
  std::optional<std::int64_t> last_;
  std::int64_t received_ = 0;
  std::int64_t lost_ = 0;
};

/// A curve that is added to for hours and keeps at most 4096 points: when it is full, every other point goes.
class History {
 public:
  /// A time before the last point starts the curve again: the run went back to a checkpoint.
  void add(double time, double value);
  /// Adds those points of an older curve that are earlier than the first one here. `times` increase.
  void begin_with(const std::vector<double>& times, const std::vector<double>& values);
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> times_;
  std::vector<double> values_;
};

/// How often one rod is hit, on average [1/s of simulated time].
struct HitRates {
  double rod = 0;  ///< by other rods
  double base = 0;
  double lid = 0;
};

/// Hit rates from the counts that messages carry, over stretches with at least 10,000 hits, so that the figure is calm.
class HitCounter {
 public:
  void note(const observables_t& message);
  const HitRates& rates() const { return rates_; }

 private:
  std::optional<observables_t> begin_;  ///< of the stretch; none at the start of the run
  HitRates rates_;
};

/// What is known of one job from the API and from the bus.
struct LiveJob {
  std::string id;
  std::string label;
  std::string state = "queued";
  bool ended = false;
  std::string reason;
  double sim_time = 0;        ///< [s]
  double sim_time_total = 0;  ///< [s]; 0 while unknown
  double sim_rate = 0;        ///< simulated seconds per wall second
  double eta = -1;            ///< [s]; negative while unknown
  int n_rods = 0;
  std::optional<double> order;
  double order_mean = 0;            ///< beside `order` only
  std::optional<MeanOrder> result;  ///< of a run that is done
  double max_overlap = 0;           ///< [mm]
  History order_history;
  std::optional<double> history_begin;  ///< of `order_history` when the run's files were asked for what was before [s]
  std::optional<observables_t> observables;  ///< the newest
  std::optional<int> n_plus;                 ///< defects +1/2
  std::optional<int> n_minus;                ///< defects -1/2
  std::optional<defects_t> defects;          ///< the newest
  HitCounter hits;
  SequenceCounter observables_counter;
  SequenceCounter defects_counter;

  bool draws_film = false;  ///< all is simulated and written; the worker draws its film
  double drawn = 0;         ///< share of the film's frames that are drawn
  double film_eta = -1;     ///< until the film is drawn [s]; negative while unknown

  double fraction() const;
  bool is_running() const { return has_worker(state); }
  std::int64_t lost() const { return observables_counter.lost() + defects_counter.lost(); }
};

/// The jobs that are watched.
class LiveJobs {
 public:
  /// A JOB object of the API. While messages of a job arrive, its numbers come from them. S(t) of a run at work from
  /// before it was watched comes from the files in its directory, if it has any and they can be read.
  void note_api(const Json& job);
  /// Messages; those of jobs that the API has not named are ignored. Anybody can send them: they change what is shown
  /// of a job, but not its state, which is the daemon's to tell.
  void note(const observables_t& message);
  void note(const defects_t& message);

  const std::vector<LiveJob>& jobs() const { return jobs_; }
  /// Whether a message speaks of another state than the daemon did when it was last asked.
  bool contradicts(const job_t& message) const;
  bool all_ended() const;
  std::int64_t received() const;
  std::int64_t lost() const;

 private:
  LiveJob* find(const std::string& id);

  std::vector<LiveJob> jobs_;
  std::map<std::string, std::size_t> index_;
};

}  // namespace shaken::client
