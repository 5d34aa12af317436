// SPDX-License-Identifier: MIT
#include "server/queue/database_schema.h"

#include <array>
#include <string>

namespace shaken::server {
namespace {

// Scenes have a table of their own: listing jobs must not read them.
constexpr const char* kVersion1 = R"sql(
CREATE TABLE sweeps(
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  created_utime INTEGER NOT NULL);
CREATE INDEX sweeps_by_name ON sweeps(name);

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
  replica INTEGER NOT NULL);
CREATE INDEX jobs_by_turn ON jobs(state, priority DESC, number);

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

CREATE TABLE journal(
  sequence INTEGER PRIMARY KEY AUTOINCREMENT,
  utime INTEGER NOT NULL,
  job TEXT NOT NULL,
  from_state TEXT NOT NULL,
  to_state TEXT NOT NULL,
  attempt INTEGER NOT NULL,
  cause TEXT NOT NULL);
)sql";

constexpr const char* kVersion2 = R"sql(
ALTER TABLE jobs ADD COLUMN hold TEXT NOT NULL DEFAULT '';  -- what a held job waits for: 'request', 'room'
ALTER TABLE jobs ADD COLUMN needed_bytes INTEGER NOT NULL DEFAULT 0;  -- of room
ALTER TABLE jobs ADD COLUMN crashes INTEGER NOT NULL DEFAULT 0;  -- in a row, without a checkpoint between them
ALTER TABLE jobs ADD COLUMN not_before_utime INTEGER NOT NULL DEFAULT 0;
)sql";

constexpr const char* kVersion3 = R"sql(
ALTER TABLE jobs ADD COLUMN soft_limit_ms INTEGER NOT NULL DEFAULT 0;  -- of one attempt; 0: none
ALTER TABLE jobs ADD COLUMN time_limit_ms INTEGER NOT NULL DEFAULT 0;  -- of all attempts; 0: none
ALTER TABLE jobs ADD COLUMN wall_ms INTEGER NOT NULL DEFAULT 0;  -- of all attempts since it was asked for last
UPDATE jobs SET wall_ms = MAX(0, (finished_utime - started_utime) / 1000) WHERE state = 'done';
ALTER TABLE jobs ADD COLUMN turn INTEGER NOT NULL DEFAULT 0;  -- line of the journal with which it came to wait
UPDATE jobs SET turn = number;
ALTER TABLE jobs ADD COLUMN waits INTEGER NOT NULL DEFAULT 0;  -- 1: for the prerequisites of its sweep
CREATE INDEX jobs_that_wait ON jobs(sweep) WHERE waits = 1;
DROP INDEX jobs_by_turn;
CREATE INDEX jobs_by_turn ON jobs(state, waits, priority DESC, turn, number, sweep, not_before_utime);

ALTER TABLE sweeps ADD COLUMN at_most INTEGER NOT NULL DEFAULT 0;  -- jobs at once; 0: any number
ALTER TABLE sweeps ADD COLUMN stop_if TEXT NOT NULL DEFAULT '';
ALTER TABLE sweeps ADD COLUMN stopped INTEGER NOT NULL DEFAULT 0;  -- 1: by that rule
CREATE INDEX sweeps_with_limit ON sweeps(id) WHERE at_most > 0;
CREATE INDEX members_by_job ON members(job);

CREATE TABLE prerequisites(                  -- what is to be done before the jobs of a sweep start
  sweep INTEGER NOT NULL REFERENCES sweeps,
  position INTEGER NOT NULL,
  target TEXT NOT NULL,                      -- 's3', or the id of a job
  PRIMARY KEY(sweep, position)) WITHOUT ROWID;
CREATE INDEX prerequisites_by_target ON prerequisites(target);
)sql";

constexpr const char* kVersion4 = R"sql(
ALTER TABLE jobs ADD COLUMN longer INTEGER NOT NULL DEFAULT 0;  -- 1: asked to go on longer while it runs
CREATE TABLE upgrades(name TEXT PRIMARY KEY);                   -- nothing uses it any more
)sql";

constexpr const char* kVersion5 = R"sql(
ALTER TABLE sweeps ADD COLUMN executor TEXT NOT NULL DEFAULT '';  -- where its jobs run; '': where the daemon's do
ALTER TABLE sweeps ADD COLUMN settings TEXT NOT NULL DEFAULT '';  -- what it asks of that executor, as JSON
ALTER TABLE jobs ADD COLUMN worker TEXT NOT NULL DEFAULT '';      -- by which a worker that outlives the daemon is found
)sql";

/// What makes each version of the one before; the first, of an empty file.
constexpr std::array kSteps{kVersion1, kVersion2, kVersion3, kVersion4, kVersion5};
constexpr auto kVersion = static_cast<std::int64_t>(kSteps.size());

std::int64_t version(Database& database) {
  Query query = database.query("PRAGMA user_version");
  query.next();
  return query.integer(0);
}

std::string damage(Database& database) {
  Query query = database.query("PRAGMA quick_check(1)");
  query.next();
  return query.text(0);
}

}  // namespace

void prepare_schema(Database& database) {
  const std::string found = damage(database);
  if (found != "ok") throw StorageError("queue.db is damaged: " + found);

  const std::int64_t stored = version(database);
  if (stored == kVersion) return;
  if (stored > kVersion || stored < 0) {
    throw StorageError("queue.db has schema version " + std::to_string(stored) + ", this shakend knows version " +
                       std::to_string(kVersion) + ": use the Shaken that wrote it, or another --root");
  }
  Transaction transaction(database);
  for (auto step = static_cast<std::size_t>(stored); step < kSteps.size(); ++step) database.execute(kSteps[step]);
  database.execute(("PRAGMA user_version = " + std::to_string(kVersion)).c_str());
  transaction.commit();
}

}  // namespace shaken::server
