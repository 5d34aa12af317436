#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace shaken::server {

/// The store cannot be read or written: disk full, I/O error, damaged file. What was asked for has not happened.
struct StorageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One execution of a prepared statement: `while (query.next()) query.text(0)`. Ends with its scope.
class Query {
 public:
  /// The values are those of ?1, ?2, ... in the statement.
  template <class... Values>
  Query(sqlite3* database, sqlite3_stmt* statement, const Values&... values)
      : database_(database), statement_(statement) {
    int index = 0;
    (bind(++index, values), ...);
  }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;
  ~Query();

  /// Goes to the next row; false after the last.
  bool next();
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;

 private:
  void bind(int index, std::int64_t value);
  void bind(int index, int value) { bind(index, static_cast<std::int64_t>(value)); }
  void bind(int index, std::string_view value);

  sqlite3* database_;
  sqlite3_stmt* statement_;
};

/// A connection to a SQLite file in WAL mode; every commit is on the disk when it returns (synchronous=FULL).
/// Not for several threads. Every function throws StorageError.
class Database {
 public:
  explicit Database(const std::filesystem::path& file);
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  ~Database();

  /// For another connection that keeps the file.
  void wait_at_most(std::chrono::milliseconds time);

  /// Runs SQL without values or rows; may be several statements.
  void execute(const char* sql);

  /// Prepares the statement on its first use, and binds the values.
  template <class... Values>
  Query query(std::string_view sql, const Values&... values) {
    return Query(handle_, prepared(sql), values...);
  }

  /// Runs a statement that gives no rows; returns how many rows it changed.
  template <class... Values>
  int run(std::string_view sql, const Values&... values) {
    query(sql, values...).next();
    return changes();
  }

  std::int64_t last_row_id() const;

 private:
  sqlite3_stmt* prepared(std::string_view sql);
  int changes() const;

  sqlite3* handle_ = nullptr;
  std::map<std::string, sqlite3_stmt*, std::less<>> statements_;
};

/// All or nothing: what was changed since the construction is undone unless commit() is reached.
class Transaction {
 public:
  explicit Transaction(Database& database);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace shaken::server
