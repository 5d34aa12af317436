// The states of a job, as base/job_state.h has them: a test writes this (SHAKEN_UPDATE_DOCS=1).
// states: begin
export const kJobStates = {
  "queued": {"has_worker":false,"requests":["hold","cancel"]},
  "held": {"has_worker":false,"requests":["resume","cancel"]},
  "running": {"has_worker":true,"requests":["hold","cancel"]},
  "stopping": {"has_worker":true,"requests":[]},
  "done": {"has_worker":false,"requests":[]},
  "failed": {"has_worker":false,"requests":["retry"]},
  "timed out": {"has_worker":false,"requests":["retry"]},
  "cancelled": {"has_worker":false,"requests":["retry"]},
};
// states: end
