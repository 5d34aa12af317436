#include <fmt/format.h>

#include <optional>

#include "base/files.h"
#include "base/interrupt.h"
#include "base/keys/units.h"
#include "base/progress_line.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"
#include "run/export/columns.h"
#include "run/export/frames.h"
#include "run/files/directory.h"
#include "run/files/foreign_file.h"
#include "scene/keys/observables.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormats[] = {"extxyz", "gsd", "xyz", "csv"};
constexpr const char* kSummary = "summary";
constexpr const char* kStandardOutput = "-";

class Export : public Verb {
 public:
  VerbInfo info() const override {
    return {"export", kResultsGroup, "A run's rods or curves as files of other programs: OVITO, VMD, tables",
            "  shaken export 1f0c --format gsd                      -> 1f0c5e2a.gsd: OVITO draws the rods as they are\n"
            "  shaken export runs/first -o first.extxyz             text, one line a rod: OVITO, ASE\n"
            "  shaken export runs/first --format xyz -o -           text, one line a bead, to stdout: VMD, MDAnalysis\n"
            "  shaken export runs/first --format gsd --from 2s --to 4s --every 10\n"
            "  shaken export runs/first --format extxyz --last      the last frame only\n"
            "  shaken export runs/first --list                      the names for --observable\n"
            "  shaken export runs/first --format csv --observable msd\n"
            "  shaken export runs/first --format csv --observable summary     all numbers with their errors",
            kExitCodesOfDaemon};
  }

  void declare(Arguments& arguments) override {
    arguments.required("RUN", id_, "A job, by the beginning of its id, or a run directory", Names::kJobOrFolder);
    arguments.option("--format", format_, "extxyz|gsd|xyz|csv", "By the suffix of --out if left out", Names::kAnything);
    arguments.option("-o,--out", out_, "FILE", "Where to write; - is stdout. Named after the run if left out",
                     Names::kFile);
    arguments.option("--from", from_, "TIME", "Frames: none earlier, e.g. 2s", Names::kAnything);
    arguments.option("--to", to_, "TIME", "Frames: none later", Names::kAnything);
    arguments.option("--every", every_, "N", "Frames: of those, the first and every Nth after it");
    arguments.flag("--last", last_, "Frames: of those, the last one only");
    arguments.repeatable("--observable", observables_, "NAME",
                         "csv: a group or an array of observables.h5, or summary; repeatable");
    arguments.flag("--list", list_, "Print the names for --observable");
  }

  ExitCode run(const Context& context) override {
    const run::WantedFrames wanted = read_options();
    find_run(context);
    if (list_) return list_names(context.console);
    return format_ == "csv" ? write_table(context.console) : write_frames(wanted, context.console);
  }

 private:
  bool chooses_frames() const { return !from_.empty() || !to_.empty() || every_ || last_; }
  bool to_stdout() const { return out_ == kStandardOutput; }

  static bool is_format(std::string_view word) {
    return std::find(std::begin(kFormats), std::end(kFormats), word) != std::end(kFormats);
  }

  /// Settles the format, and collects what is wrong with the options.
  run::WantedFrames read_options() {
    std::string problems;
    const auto add_problem = [&](const std::string& problem) { problems += problem + "\n"; };
    run::WantedFrames wanted;
    const auto time = [&](const char* option, const std::string& text) -> std::optional<double> {
      if (text.empty()) return std::nullopt;
      const auto value = keys::parse_quantity(text, keys::Dimension::kTime);
      if (value) return *value;
      add_problem(fmt::format("{}: {}", option, value.error().message));
      return std::nullopt;
    };
    wanted.from = time("--from", from_);
    wanted.to = time("--to", to_);
    if (wanted.from && wanted.to && *wanted.from > *wanted.to) add_problem("--from is later than --to");
    if (every_ && *every_ < 1) add_problem(fmt::format("--every takes a number from 1, not {}", *every_));
    wanted.every = static_cast<std::size_t>(std::max(every_.value_or(1), 1));
    wanted.only_last = last_;

    const fs::path out(out_);
    const std::string suffix = out.has_extension() ? out.extension().string().substr(1) : "";
    if (list_) {
      if (!format_.empty() || !out_.empty() || !observables_.empty() || chooses_frames()) {
        add_problem("--list prints names and takes no other option");
      }
    } else if (!format_.empty() && !is_format(format_)) {
      add_problem(fmt::format("--format takes extxyz, gsd, xyz or csv, not '{}'", printable(format_)));
    } else if (format_.empty() && !is_format(suffix)) {
      add_problem("--format is missing: extxyz, gsd, xyz or csv");
    } else {
      if (format_.empty()) format_ = suffix;
      if (is_format(suffix) && suffix != format_) {
        add_problem(fmt::format("--format {} does not go with {}", format_, printable(out_)));
      }
      if (format_ == "gsd" && to_stdout()) add_problem("gsd is no text: --out takes a file for it");
      if (format_ == "csv" && chooses_frames()) add_problem("--from, --to, --every and --last choose frames, not csv");
      if (format_ == "csv" && observables_.empty()) {
        add_problem(fmt::format("csv takes --observable NAME; `shaken export {} --list` lists the names",
                                shell_word(printable(id_))));
      }
      if (format_ != "csv" && !observables_.empty()) add_problem("--observable goes with --format csv");
      if (wants_summary() && observables_.size() > 1) add_problem("--observable summary stands by itself");
    }
    std::error_code ignored;
    if (!out_.empty() && !to_stdout() && fs::exists(out, ignored) && !fs::is_regular_file(out, ignored)) {
      add_problem(fmt::format("{} is no file that could be replaced{}", printable(out_),
                              fs::is_directory(out, ignored) ? ": give a name in it" : ": --out - writes to stdout"));
    }
    if (!problems.empty()) {
      problems.pop_back();
      throw Failure(ExitCode::kBadInput, problems);
    }
    return wanted;
  }

  bool wants_summary() const {
    return std::find(observables_.begin(), observables_.end(), kSummary) != observables_.end();
  }

  void find_run(const Context& context) {
    if (is_run_directory(id_)) {
      files_.root = id_;
      name_ = fs::weakly_canonical(id_).filename().string();
      return;
    }
    ApiClient session(context.root());
    const Json job = find_job(session, id_);
    files_.root = job.at("directory").get<std::string>();
    name_ = short_id(job.at("id").get<std::string>());
  }

  /// Throws Failure unless `file` is there.
  static void require(const fs::path& file, const char* remedy) {
    std::error_code ignored;
    if (fs::exists(file, ignored)) return;
    throw Failure(ExitCode::kBadInput, fmt::format("there is no {}: {}", printable(file.string()), remedy));
  }

  run::Observables read_observables() const {
    require(files_.observables(), "the run has measured nothing yet, or its scene asks for nothing");
    done_or_fail(run::try_to_read(files_.observables()));
    return value_or_fail(run::read_observables(files_.observables()));
  }

  ExitCode list_names(Console& console) const {
    std::error_code ignored;
    if (fs::exists(files_.summary(), ignored)) console.out << kSummary << "\n";
    if (!fs::exists(files_.summary(), ignored) || fs::exists(files_.observables(), ignored)) {
      console.out << run::observables_list(read_observables());
    }
    return ExitCode::kOk;
  }

  ExitCode write_table(Console& console) {
    std::string text;
    if (wants_summary()) {
      require(files_.summary(), "the run has not ended");
      const auto table = run::summary_csv(value_or_fail(read_file(files_.summary())));
      if (!table) throw Failure(ExitCode::kFailed, files_.summary().string() + ": " + table.error().message);
      text = *table;
    } else {
      text = value_or_fail(run::observables_csv(read_observables(), observables_), ExitCode::kBadInput);
    }
    if (to_stdout()) return print(console, text);
    if (out_.empty()) out_ = fmt::format("{}-{}.csv", name_, fs::path(observables_.front()).filename().string());
    done_or_fail(write_file_atomically(out_, text));
    console.out << printable(out_) << "\n";
    return ExitCode::kOk;
  }

  static ExitCode print(Console& console, std::string_view text) {
    console.out.write(text.data(), static_cast<std::streamsize>(text.size())).flush();
    if (!console.out.good()) throw Failure(ExitCode::kFailed, "cannot write to stdout");
    return ExitCode::kOk;
  }

  ExitCode write_frames(const run::WantedFrames& wanted, Console& console) {
    require(files_.recorded(), "the run records no frames: its scene needs a \"trajectory\" or \"movie\" block");
    done_or_fail(run::try_to_read(files_.recorded()));
    const auto trajectory = value_or_fail(run::TrajectoryReader::open(files_.recorded()));
    const run::FrameRange range = value_or_fail(run::find_frames(trajectory, wanted), ExitCode::kBadInput);
    const std::unique_ptr<run::FrameFormat> format = make_format(trajectory.header(), range.size());
    if (out_.empty()) out_ = name_ + "." + format_;

    std::optional<ReplacementFile> file;
    if (!to_stdout()) file.emplace(value_or_fail(ReplacementFile::create(out_)));
    double n_bytes = 0;
    const run::Sink sink = [&](std::string_view bytes) -> Result<void> {
      n_bytes += static_cast<double>(bytes.size());
      if (file) return file->append(bytes);
      print(console, bytes);
      return {};
    };
    const InterruptGuard guard;
    ProgressLine progress(console.err, console.err_is_terminal, console.width, 0);
    const auto goes_on = [&](std::size_t n_done) {
      const double fraction = static_cast<double>(n_done) / static_cast<double>(range.size());
      progress.show(progress_text(fraction, fmt::format("{}/{} frames", n_done, range.size()), -1));
      return !guard.interrupted();
    };
    const std::size_t n_done = value_or_fail(run::export_frames(trajectory, range, *format, sink, goes_on));
    progress.clear();
    if (n_done < range.size()) {
      console.err << fmt::format("interrupted after {} of {} frames{}\n", n_done, range.size(),
                                 file ? ": nothing is written" : "");
      return ExitCode::kInterrupted;
    }
    if (!file) return ExitCode::kOk;
    done_or_fail(file->finish());
    console.out << fmt::format("{}: {} of {}, {}\n", printable(out_), counted(n_done, "frame"),
                               counted(static_cast<std::size_t>(trajectory.header().n_rods), "rod"),
                               bytes_text(n_bytes));
    return ExitCode::kOk;
  }

  std::unique_ptr<run::FrameFormat> make_format(const run::TrajectoryHeader& header, std::size_t n_frames) const {
    if (format_ == "gsd") return run::make_gsd(header, n_frames);
    if (format_ == "xyz") return run::make_beads_xyz(header);
    return run::make_extended_xyz(header);
  }

  std::string id_;
  std::string format_;
  std::string out_;
  std::string from_;
  std::string to_;
  std::optional<int> every_;
  bool last_ = false;
  std::vector<std::string> observables_;
  bool list_ = false;

  run::RunDirectory files_;
  std::string name_;  ///< of what is written, without suffix
};

}  // namespace

std::unique_ptr<Verb> make_export() { return std::make_unique<Export>(); }

}  // namespace shaken::client
