#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/core/result.h"
#include "run/files/provenance.h"

namespace shaken::run {

/// The arrays of observables.h5, by path in the file: "/msd/total_mm2". Names end in their units; a standard error has
/// `_sem` before the unit. run/measure/NAME.cpp says which there are below "/NAME/".
using Observables = std::map<std::string, std::vector<double>>;

/// Every data set has its unit as the attribute `unit` (unit_of_name), the file says which run it is of.
Result<void> write_observables(const std::filesystem::path& file, const Observables& arrays,
                               const Provenance& provenance = {});
/// All one-dimensional arrays of the file. One that is not what the run has written is refused before HDF5 reads it
/// (run/files/content_hash.h).
Result<Observables> read_observables(const std::filesystem::path& file);

}  // namespace shaken::run
