#!/usr/bin/env python3
"""Holds every #include of the project against the order of its layers. Exits 1 and lists what breaks it.

Data walks one way: scene -> world -> stepper -> observables -> files and bus -> pictures. A folder may include itself
and what stands beside it here, nothing else of ours; base/core, the ground floor, everything may include."""
import pathlib
import re
import sys

# Inside the physics library: each may include what stands before it, so there are no circles.
SIM = ["sim/lanes", "sim/gravity.h", "sim/system.h", "sim/physics_version.h", "sim/snapshot.h", "sim/posts.h",
       "sim/rod", "sim/cell.h", "sim/motion", "sim/posts.cpp", "sim/contact", "sim/neighbors", "sim/ledger.h",
       "sim/world", "sim/balance", "sim/close_up", "sim/overlaps", "sim/effects", "sim/tick", "sim/bounds",
       "sim/schedule", "sim/stepping", "sim/start", "sim/checkpoint", "sim/simulation"]
ALLOWED = {
    "base/core": [],
    "base": [],
    "base/http": ["base"],
    "base/keys": [],
    "proto": ["sim/cell.h"],
    # everything outside sim/ sees simulations, not steppers
    "analysis": ["base/estimate.h", "sim/system.h", "sim/cell.h", "sim/motion/side_walls.h"],
    "scene": ["base/keys", "sim/rod", "sim/cell.h", "sim/posts.h", "sim/system.h",
              "sim/physics_version.h"],
    # whether rods can be placed, or a run begin where another ends, the simulation itself says
    "scene/sweeps/stages.cpp": ["scene", "base/keys", "sim/start/from_another_run.h"],
    "scene/placement.cpp": ["scene", "base/keys", "sim/rod", "sim/system.h", "sim/start/initial.h"],
    # a film is as large as the renderer can draw it
    "scene/keys/field_table.cpp": ["scene/keys", "base/keys", "base/picture_limits.h", "sim/rod", "sim/system.h"],
    # a sweep's name is printed
    "scene/sweeps/sweep.cpp": ["scene", "base/keys", "base/text.h", "sim/rod", "sim/system.h"],
    # how long a run was to go on stands in its scene
    "run/files/done.h": ["run/files", "scene/keys/run_plan.h"],
    "run/files/done.cpp": ["run/files", "base", "scene"],
    # what comes from a file is held against what a scene allows
    "run/files/frame_log.cpp": ["run/files", "base", "scene/keys/cell_limits.h"],
    # S of a frame is that of the measurement
    "run/files/order_curve.cpp": ["run/files", "base", "analysis/order.h"],
    "run/files": ["base", "sim/cell.h", "sim/snapshot.h"],
    # whether rods of another run are those of a scene, and how fast rods are at a start, the simulation itself says
    "run/import": ["run/files", "run/loop", "base", "scene", "sim/motion/start_motion.h",
                   "sim/start/from_another_run.h", "sim/close_up.h", "sim/overlaps.h", "sim/simulation.h",
                   "sim/system.h", "sim/world.h"],
    "run": ["proto", "base", "scene", "analysis", "sim/rod", "sim/cell.h", "sim/system.h",
            "sim/snapshot.h", "sim/world.h", "sim/simulation.h", "sim/balance.h", "sim/close_up.h", "sim/overlaps.h",
            "sim/effects/registry.h", "sim/motion/side_walls.h", "sim/physics_version.h"],
    # drawing knows rods and fields; only the program's sources of frames know files and the bus
    "render/main.cpp": ["render", "base", "run/files"],
    "render/program": ["render", "base", "proto/bus.h"],
    # plates are drawn where they are
    "render/sources.h": ["render", "run/files", "scene/keys/run_plan.h", "sim/motion/plates.h"],
    # what comes from the bus is held against what a scene allows
    "render/sources.cpp": ["render", "base/files.h", "base/text.h", "base/keys", "run/files", "proto", "scene",
                           "analysis"],
    # the settings of a sweep, with their units
    "render/headline.cpp": ["render", "base/keys", "scene/keys/fields.h"],
    # the defaults of the director field whose defects are drawn
    "render/measure.cpp": ["render", "scene/keys/measure_plan.h", "sim/system.h", "analysis"],
    # films are encoded by the program ffmpeg
    "render/movie.cpp": ["render", "base"],
    "render": ["base/files.h", "base/keys", "base/palettes.h", "base/picture_limits.h", "base/text.h", "sim/cell.h",
               "sim/snapshot.h", "analysis"],
    "proto/relay": ["proto", "base"],
    "server": ["proto", "proto/relay", "base/http", "base", "scene", "run/files"],
    # the options of pictures are the keys of styles
    "client/picture_options.cpp": ["client", "base", "render/style_keys.h"],
    # where rods are too thin for the terminal, their director is drawn
    "client/watch/director_cells.cpp": ["client", "analysis/geometry/director_field.h", "scene/keys/measure_plan.h"],
    # walls are drawn where they are
    "client/watch/rod_samples.cpp": ["client", "sim/motion/side_walls.h"],
    "client/verbs/schema.cpp": ["client", "scene", "render/style_file.h"],
    # what is handed on to the worker is declared there
    "client/verbs/import.cpp": ["client", "base", "run/import/import_run.h"],
    "client/verbs/measure.cpp": ["client", "base", "run/recorded/measure_command.h"],
    # all that has a name
    "client/catalogue.cpp": ["client/catalogue.h", "client/live/json.h", "base", "scene", "render/style_keys.h",
                             "run/files/unit_of_name.h", "run/loop/summary.h", "run/measure/measurement_kinds.h",
                             "sim/effects/registry.h"],
    "client": ["proto", "base", "scene", "run/files", "sim/rod", "sim/cell.h", "sim/system.h"],
    # the page in a browser: what the terminal's live view makes of messages, the daemon's way of HTTP, a run's files
    "web": ["proto", "base", "client/live", "client/starter_scene.h", "base/http", "run/files", "analysis/order.h",
            "sim/system.h"],
    # the compiled half of the Python package: runs in the process of a notebook
    "python/native": ["base", "base/keys", "scene", "run", "sim/cell.h", "sim/snapshot.h", "sim/simulation.h",
                      "sim/world.h", "sim/motion/side_walls.h", "sim/start/from_another_run.h"],
    # benches time whole simulations
    "bench": ["base", "scene", "run/files", "analysis", "sim/rod", "sim/system.h", "sim/snapshot.h", "sim/world.h",
              "sim/balance.h", "sim/simulation.h", "sim/effects/registry.h", "sim/motion/start_motion.h"],
}
# Rooms of a folder: each may use what the folder may, and the rooms before it.
ROOMS = {"analysis": ["errors", "geometry", "lags"], "scene": ["keys", "resolve"],
         "run": ["files", "measure", "live", "loop", "import", "recorded", "cost", "worker"]}
for folder, rooms in ROOMS.items():
    for floor, room in enumerate(rooms):
        before = [f"{folder}/{below}" for below in rooms[:floor]]
        ALLOWED.setdefault(f"{folder}/{room}", ALLOWED[folder] + before)
for floor, name in enumerate(SIM):
    for part in [name] if "." in name else [name, name + ".h", name + ".cpp"]:
        ALLOWED[part] = [below + end for below in SIM[:floor + 1] for end in ("", ".h", ".cpp")]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
FOLDERS = ("sim", "proto", "base", "scene", "analysis", "run", "render", "server", "client", "web", "tests", "bench",
           "python")


def rule(path):
    """The most specific entry of ALLOWED that `path` falls under."""
    matches = [key for key in ALLOWED if path == key or path.startswith(key + "/")]
    return max(matches, key=len) if matches else None


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    bad = []
    n_includes = 0
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            name = file.relative_to(root).as_posix()
            key = rule(name)
            for number, line in enumerate(file.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                n_includes += 1
                target = match.group(1)
                if not (root / target).exists():
                    bad.append(f"{name}:{number}: \"{target}\" is not a path from the root")
                elif key is None:
                    continue  # tests may use anything
                elif rule(target) is None:
                    bad.append(f"{name}:{number}: {target} is for tests only")
                elif not any(target == a or target.startswith(a + "/") for a in [key, "base/core", *ALLOWED[key]]):
                    bad.append(f"{name}:{number}: {key} must not use {target}")
    print("\n".join(bad) if bad else f"layering: {n_includes} includes in order")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
