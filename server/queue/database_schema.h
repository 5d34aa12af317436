#pragma once

#include <span>
#include <string>
#include <string_view>

#include "server/queue/sqlite.h"

namespace shaken::server {

/// Makes the next version of the tables of the one before.
using Migration = void (*)(Database&);

/// Those of this program since its first version, in order. The next version is one function more.
std::span<const Migration> migrations();

/// SQL by which jobs that fulfil `condition` get the work that their scenes ask for: rods times simulated seconds, as
/// far as it gives them; 1 where it does not tell.
std::string update_of_work(std::string_view condition);

/// Creates the queue's tables in an empty file, and brings those of an older version up to this program's. Throws
/// StorageError if the file is damaged, or of a version that this program cannot read.
void prepare_schema(Database& database, std::span<const Migration> upgrades = migrations());

}  // namespace shaken::server
