#pragma once

#include <memory>

#include "client/verb.h"

namespace shaken::client {

inline constexpr const char* kPrepareGroup = "Prepare";
inline constexpr const char* kControlGroup = "Run and control";
inline constexpr const char* kResultsGroup = "Results";
inline constexpr const char* kHelpGroup = "Set-up and help";

std::unique_ptr<Verb> make_init();
std::unique_ptr<Verb> make_schema();
std::unique_ptr<Verb> make_validate();
std::unique_ptr<Verb> make_explain();
std::unique_ptr<Verb> make_calibrate();
std::unique_ptr<Verb> make_import();
std::unique_ptr<Verb> make_measure();
std::unique_ptr<Verb> make_run();
std::unique_ptr<Verb> make_submit();
std::unique_ptr<Verb> make_status();
std::unique_ptr<Verb> make_watch();
std::unique_ptr<Verb> make_web();
std::unique_ptr<Verb> make_record();
std::unique_ptr<Verb> make_replay_log();
std::unique_ptr<Verb> make_logs();
std::unique_ptr<Verb> make_wait();
std::unique_ptr<Verb> make_history();
std::unique_ptr<Verb> make_extend();
std::unique_ptr<Verb> make_hold();
std::unique_ptr<Verb> make_resume();
std::unique_ptr<Verb> make_retry();
std::unique_ptr<Verb> make_priority();
std::unique_ptr<Verb> make_cancel();
std::unique_ptr<Verb> make_clean();
std::unique_ptr<Verb> make_results();
std::unique_ptr<Verb> make_plot();
std::unique_ptr<Verb> make_figures();
std::unique_ptr<Verb> make_picture();
std::unique_ptr<Verb> make_movie();
std::unique_ptr<Verb> make_export();
std::unique_ptr<Verb> make_replay();
std::unique_ptr<Verb> make_pack();
std::unique_ptr<Verb> make_unpack();
std::unique_ptr<Verb> make_bench();
std::unique_ptr<Verb> make_doctor();
std::unique_ptr<Verb> make_completion();
std::unique_ptr<Verb> make_cite();

}  // namespace shaken::client
