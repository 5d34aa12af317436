#include "server/queue/sqlite.h"

#include <sqlite3.h>

#include <cerrno>
#include <cstring>

namespace shaken::server {
namespace {

/// What the system said, which SQLite's "disk I/O error" does not: " (No space left on device)", say.
std::string system_reason(sqlite3* database) {
  const int code = sqlite3_errcode(database) & 0xFF;
  const int reason = code == SQLITE_FULL                               ? ENOSPC
                     : code == SQLITE_IOERR || code == SQLITE_CANTOPEN ? sqlite3_system_errno(database)
                                                                       : 0;
  return reason != 0 ? std::string(" (") + std::strerror(reason) + ")" : "";
}

[[noreturn]] void fail(sqlite3* database) {
  const char* file = sqlite3_db_filename(database, "main");
  throw StorageError(std::string(file != nullptr ? file : "queue") + ": " + sqlite3_errmsg(database) +
                     system_reason(database));
}

}  // namespace

Query::~Query() {
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
}

void Query::bind(int index, std::int64_t value) {
  if (sqlite3_bind_int64(statement_, index, value) != SQLITE_OK) fail(database_);
}

void Query::bind(int index, std::string_view value) {
  // A null pointer would bind NULL, not the empty text.
  const char* data = value.data() != nullptr ? value.data() : "";
  const int status = sqlite3_bind_text64(statement_, index, data, value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  if (status != SQLITE_OK) fail(database_);
}

bool Query::next() {
  const int status = sqlite3_step(statement_);
  if (status == SQLITE_ROW) return true;
  if (status != SQLITE_DONE) fail(database_);
  return false;
}

double Query::real(int column) const { return sqlite3_column_double(statement_, column); }
std::int64_t Query::integer(int column) const { return sqlite3_column_int64(statement_, column); }

std::string Query::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return data != nullptr ? std::string(data, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)))
                         : std::string();
}

Database::Database(const std::filesystem::path& file) {
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  try {
    if (sqlite3_open_v2(file.c_str(), &handle_, kFlags, nullptr) != SQLITE_OK) {
      throw StorageError(file.string() + ": " +
                         (handle_ != nullptr ? sqlite3_errmsg(handle_) + system_reason(handle_) : "out of memory"));
    }
    sqlite3_extended_result_codes(handle_, 1);
    wait_at_most(std::chrono::milliseconds(5000));  // somebody may look into the file with the sqlite3 program
    execute("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON");
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Database::~Database() {
  for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
  sqlite3_close(handle_);
}

void Database::wait_at_most(std::chrono::milliseconds time) {
  sqlite3_busy_timeout(handle_, static_cast<int>(time.count()));
}

void Database::execute(const char* sql) {
  if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(handle_);
}

sqlite3_stmt* Database::prepared(std::string_view sql) {
  const auto known = statements_.find(sql);
  if (known != statements_.end()) return known->second;
  sqlite3_stmt* statement = nullptr;
  const int length = static_cast<int>(sql.size());
  if (sqlite3_prepare_v3(handle_, sql.data(), length, SQLITE_PREPARE_PERSISTENT, &statement, nullptr) != SQLITE_OK) {
    fail(handle_);
  }
  return statements_.emplace(sql, statement).first->second;
}

std::int64_t Database::last_row_id() const { return sqlite3_last_insert_rowid(handle_); }

int Database::changes() const { return sqlite3_changes(handle_); }

Transaction::Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const StorageError&) {
    // SQLite has rolled back by itself: that is what it does after an I/O error or on a full disk.
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

}  // namespace shaken::server
