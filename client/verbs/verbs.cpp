#include "client/verbs/verbs.h"

namespace shaken::client {

Verbs make_verbs() {
  Verbs verbs;
  for (const auto make :
       {make_init,       make_schema,  make_validate, make_explain, make_calibrate,  make_import,  make_run,
        make_submit,     make_status,  make_watch,    make_record,  make_replay_log, make_web,     make_logs,
        make_history,    make_wait,    make_extend,   make_hold,    make_resume,     make_retry,   make_priority,
        make_cancel,     make_clean,   make_results,  make_plot,    make_figures,    make_picture, make_movie,
        make_export,     make_measure, make_replay,   make_pack,    make_unpack,     make_bench,   make_doctor,
        make_completion, make_cite}) {
    verbs.push_back(make());
  }
  return verbs;
}

}  // namespace shaken::client
