// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace shaken::bench {

/// Makes `folder` if it is not there; throws Failure if it cannot be.
void make_folder(const std::filesystem::path& folder);
/// Writes a file whole; throws Failure if the disk refuses.
void write_text(const std::filesystem::path& file, const std::string& text);

/// The gnuplot lines that every picture begins with: a terminal that writes NAME.png, `width` x `height` pixels.
std::string gnuplot_prologue(const std::string& name, int width, int height);

/// Writes NAME.dat and NAME.gp into `folder` and has gnuplot draw NAME.png; throws Failure with gnuplot's words if that
/// does not work.
void draw(const std::filesystem::path& folder, const std::string& name, const std::string& data,
          const std::string& script);

}  // namespace shaken::bench
