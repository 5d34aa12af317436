// What the page reads of the catalogue (client/catalogue.h): a test writes this (SHAKEN_UPDATE_DOCS=1).
// catalogue: begin
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
export const kSteadiness = {
  "true": {"mark":"","word":"steady"},
  "false": {"mark":"~","word":"still relaxing"},
  "null": {"mark":"?","word":"not known to be steady"},
};
export const kAverages = ["order.mean","order.std","defects.mean_plus","defects.mean_minus"];
// catalogue: end
