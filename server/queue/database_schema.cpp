#include "server/queue/database_schema.h"

#include <fmt/format.h>

#include <array>
#include <string>

namespace shaken::server {
namespace {

// Scenes have a table of their own: listing jobs must not read them.
constexpr const char* kTables = R"sql(
CREATE TABLE sweeps(
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  created_utime INTEGER NOT NULL,
  at_most INTEGER NOT NULL DEFAULT 0,        -- jobs at once; 0: any number
  stop_if TEXT NOT NULL DEFAULT '',
  stopped INTEGER NOT NULL DEFAULT 0,        -- 1: by that rule
  executor TEXT NOT NULL DEFAULT '',         -- where its jobs run; '': where the daemon's do
  settings TEXT NOT NULL DEFAULT '');        -- what it asks of that executor, as JSON
CREATE INDEX sweeps_by_name ON sweeps(name);
CREATE INDEX sweeps_with_limit ON sweeps(id) WHERE at_most > 0;

CREATE TABLE jobs(
  number INTEGER PRIMARY KEY AUTOINCREMENT,  -- order of arrival
  id TEXT NOT NULL UNIQUE,
  state TEXT NOT NULL,
  after_stop TEXT NOT NULL DEFAULT '',       -- what a stopping job becomes
  reason TEXT NOT NULL DEFAULT '',
  priority INTEGER NOT NULL,
  attempt INTEGER NOT NULL DEFAULT 0,
  pid INTEGER NOT NULL DEFAULT 0,
  created_utime INTEGER NOT NULL,
  started_utime INTEGER NOT NULL DEFAULT 0,
  finished_utime INTEGER NOT NULL DEFAULT 0,
  sweep INTEGER NOT NULL REFERENCES sweeps,  -- the last that asked for it, and under which name there
  label TEXT NOT NULL,
  parameters TEXT NOT NULL,
  replica INTEGER NOT NULL,
  hold TEXT NOT NULL DEFAULT '',             -- what a held job waits for: 'request', 'room'
  needed_bytes INTEGER NOT NULL DEFAULT 0,   -- of room
  crashes INTEGER NOT NULL DEFAULT 0,        -- in a row, without a checkpoint between them
  not_before_utime INTEGER NOT NULL DEFAULT 0,
  soft_limit_ms INTEGER NOT NULL DEFAULT 0,  -- of one attempt; 0: none
  time_limit_ms INTEGER NOT NULL DEFAULT 0,  -- of all attempts; 0: none
  wall_ms INTEGER NOT NULL DEFAULT 0,        -- of all attempts since it was asked for last
  turn INTEGER NOT NULL DEFAULT 0,           -- line of the journal with which it came to wait
  waits INTEGER NOT NULL DEFAULT 0,          -- 1: for the prerequisites of its sweep
  longer INTEGER NOT NULL DEFAULT 0,         -- 1: asked to go on longer while it runs
  worker TEXT NOT NULL DEFAULT '');          -- by which a worker that outlives the daemon is found
CREATE INDEX jobs_by_turn ON jobs(state, waits, priority DESC, turn, number, sweep, not_before_utime);
CREATE INDEX jobs_that_wait ON jobs(sweep) WHERE waits = 1;

CREATE TABLE scenes(
  job INTEGER PRIMARY KEY REFERENCES jobs,
  scene TEXT NOT NULL);

CREATE TABLE members(
  sweep INTEGER NOT NULL REFERENCES sweeps,
  position INTEGER NOT NULL,
  job INTEGER NOT NULL REFERENCES jobs,
  label TEXT NOT NULL,
  parameters TEXT NOT NULL,
  replica INTEGER NOT NULL,
  PRIMARY KEY(sweep, position)) WITHOUT ROWID;
CREATE INDEX members_by_job ON members(job);

CREATE TABLE prerequisites(                  -- what is to be done before the jobs of a sweep start
  sweep INTEGER NOT NULL REFERENCES sweeps,
  position INTEGER NOT NULL,
  target TEXT NOT NULL,                      -- 's3', or the id of a job
  PRIMARY KEY(sweep, position)) WITHOUT ROWID;
CREATE INDEX prerequisites_by_target ON prerequisites(target);

CREATE TABLE journal(
  sequence INTEGER PRIMARY KEY AUTOINCREMENT,
  utime INTEGER NOT NULL,
  job TEXT NOT NULL,
  from_state TEXT NOT NULL,
  to_state TEXT NOT NULL,
  attempt INTEGER NOT NULL,
  cause TEXT NOT NULL);
)sql";

/// The version of kTables. Those before it were never released.
constexpr std::int64_t kFirstVersion = 5;

std::int64_t version(Database& database) {
  Query query = database.query("PRAGMA user_version");
  query.next();
  return query.integer(0);
}

/// `waits` becomes a sum: 1 for the prerequisites of the sweep, 2 for the run that the job starts from.
void jobs_start_from_jobs(Database& database) {
  database.execute(R"sql(
ALTER TABLE jobs ADD COLUMN starts_from TEXT NOT NULL DEFAULT '';  -- id of a run whose end it begins at
CREATE INDEX jobs_by_start ON jobs(starts_from) WHERE starts_from <> '';
DROP INDEX jobs_that_wait;
CREATE INDEX jobs_that_wait ON jobs(sweep) WHERE waits & 1;
)sql");
}

void jobs_have_work(Database& database) {
  database.execute("ALTER TABLE jobs ADD COLUMN work REAL NOT NULL DEFAULT 1");  // rods times simulated seconds
  database.execute(update_of_work("1").c_str());
}

/// Whether a job waits for the run that it starts from follows from that run: `waits` is 1 or 0 again. What the daemon
/// looks for ten times a second has an index.
void queries_of_each_round_have_indices(Database& database) {
  database.execute(R"sql(
UPDATE jobs SET waits = waits & 1;
DROP INDEX jobs_that_wait;
CREATE INDEX jobs_that_wait ON jobs(sweep) WHERE waits;
CREATE INDEX jobs_that_pause ON jobs(not_before_utime) WHERE not_before_utime > 0;
CREATE INDEX jobs_that_need_room ON jobs(needed_bytes) WHERE needed_bytes > 0;
)sql");
}

std::string damage(Database& database) {
  Query query = database.query("PRAGMA quick_check(1)");
  query.next();
  return query.text(0);
}

}  // namespace

std::span<const Migration> migrations() {
  static constexpr std::array<Migration, 3> kMigrations{jobs_start_from_jobs, jobs_have_work,
                                                        queries_of_each_round_have_indices};
  return kMigrations;
}

std::string update_of_work(std::string_view condition) {
  // Every species has a key: rods, rods_2, ...
  return fmt::format(R"sql(
UPDATE jobs SET work = COALESCE((
  SELECT NULLIF(
      (SELECT TOTAL(json_extract(scene, '$."' || key || '".count')) FROM json_each(scene) WHERE key GLOB 'rods*') *
      (COALESCE(json_extract(scene, '$.time.steady'), 0) + COALESCE(json_extract(scene, '$.time.measure'), 0)), 0)
  FROM scenes WHERE job = number AND json_valid(scene)), 1)
WHERE {})sql",
                     condition);
}

void prepare_schema(Database& database, std::span<const Migration> upgrades) {
  const std::string found = damage(database);
  if (found != "ok") throw StorageError("queue.db is damaged: " + found);

  const std::int64_t known = kFirstVersion + std::ssize(upgrades), stored = version(database);
  if (stored == known) return;
  if (stored != 0 && (stored < kFirstVersion || stored > known)) {
    throw StorageError("queue.db has schema version " + std::to_string(stored) + ", this shakend knows version " +
                       std::to_string(known) + ": use the Shaken that wrote it, or another --root");
  }
  Transaction transaction(database);
  if (stored == 0) database.execute(kTables);  // an empty file
  const std::int64_t done = stored == 0 ? 0 : stored - kFirstVersion;
  for (const Migration migrate : upgrades.subspan(static_cast<std::size_t>(done))) migrate(database);
  database.execute(("PRAGMA user_version = " + std::to_string(known)).c_str());
  transaction.commit();
}

}  // namespace shaken::server
