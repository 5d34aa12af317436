// SPDX-License-Identifier: MIT
#include "server/queue_schema.h"

#include <string>

namespace shaken::server {
namespace {

constexpr std::int64_t kVersion = 2;

// Scenes have a table of their own: listing jobs must not read them.
constexpr const char* kSchema = R"sql(
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
  replica INTEGER NOT NULL,
  hold TEXT NOT NULL DEFAULT '',             -- what a held job waits for: 'request', 'room'
  needed_bytes INTEGER NOT NULL DEFAULT 0,   -- of room
  crashes INTEGER NOT NULL DEFAULT 0,        -- in a row, without a checkpoint between them
  not_before_utime INTEGER NOT NULL DEFAULT 0);
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

/// What version 2 added.
constexpr const char* kFromVersion1 = R"sql(
ALTER TABLE jobs ADD COLUMN hold TEXT NOT NULL DEFAULT '';
ALTER TABLE jobs ADD COLUMN needed_bytes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN crashes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN not_before_utime INTEGER NOT NULL DEFAULT 0;
)sql";

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
  database.execute(stored == 0 ? kSchema : kFromVersion1);
  database.execute(("PRAGMA user_version = " + std::to_string(kVersion)).c_str());
  transaction.commit();
}

}  // namespace shaken::server
