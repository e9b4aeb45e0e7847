-- SPDX-License-Identifier: Apache-2.0
-- A campaign file as the first version of its tables had it.
PRAGMA application_id = 1396916548;
PRAGMA user_version = 1;
CREATE TABLE runs (
  id INTEGER PRIMARY KEY, scene TEXT NOT NULL, scene_hash TEXT NOT NULL, strategy TEXT NOT NULL, seed INTEGER NOT NULL,
  settings TEXT NOT NULL, views INTEGER NOT NULL, stopped_because TEXT NOT NULL, seconds REAL NOT NULL,
  program_version TEXT NOT NULL, finished_at TEXT NOT NULL, initial_coverage REAL NOT NULL,
  initial_unknown_left INTEGER NOT NULL, initial_unknown_near_objects INTEGER NOT NULL, initial_accuracy_m REAL,
  initial_chamfer_m REAL, initial_f_score REAL, coverage REAL NOT NULL, unknown_left INTEGER NOT NULL,
  unknown_near_objects INTEGER NOT NULL, accuracy_m REAL, chamfer_m REAL, f_score REAL,
  UNIQUE (scene, scene_hash, strategy, seed, settings)
);
CREATE TABLE views (
  run INTEGER NOT NULL REFERENCES runs (id) ON DELETE CASCADE, number INTEGER NOT NULL, region INTEGER NOT NULL,
  gain REAL, T_world_camera TEXT NOT NULL, candidates INTEGER NOT NULL, frames INTEGER NOT NULL,
  points_at_object INTEGER NOT NULL, candidates_ms REAL NOT NULL, evaluation_ms REAL NOT NULL, motion_ms REAL NOT NULL,
  fusion_ms REAL NOT NULL, coverage REAL NOT NULL, unknown_left INTEGER NOT NULL,
  unknown_near_objects INTEGER NOT NULL, accuracy_m REAL, chamfer_m REAL, f_score REAL,
  PRIMARY KEY (run, number)
) WITHOUT ROWID;
CREATE VIEW curves AS
  SELECT id AS run, scene, strategy, seed, settings, 0 AS number, initial_coverage AS coverage,
         initial_unknown_left AS unknown_left, initial_unknown_near_objects AS unknown_near_objects
  FROM runs
  UNION ALL
  SELECT views.run, scene, strategy, seed, settings, number, views.coverage, views.unknown_left,
         views.unknown_near_objects
  FROM views JOIN runs ON runs.id = views.run;
INSERT INTO runs VALUES
  (1, 'jug', '00ff00ff00ff00ff', 'sphere', 1, '{"noise":true,"revision":2}', 1, 'views_used_up', 1.5, '0.1.0',
   '2024-06-30T12:00:00Z', 0.25, 1000, 100, NULL, NULL, NULL, 0.5, 900, 90, 0.0012, 0.0034, 0.9),
  (2, 'jug', '00ff00ff00ff00ff', 'sphere', 1, '{"noise":true,"revision":2,"sensor":"kinect-v2"}', 0, 'regions_done',
   1.5, '0.1.0', '2024-06-30T12:00:01Z', 0.25, 1000, 100, NULL, NULL, NULL, 0.25, 1000, 100, NULL, NULL, NULL),
  (3, 'jug', '00ff00ff00ff00ff', 'sphere', 1, '{"noise":false,"revision":2}', 0, 'regions_done',
   1.5, '0.1.0', '2024-06-30T12:00:02Z', 0.25, 1000, 100, NULL, NULL, NULL, 0.25, 1000, 100, NULL, NULL, NULL),
  (4, 'jug', '00ff00ff00ff00ff', 'sphere', 1, 'by hand', 0, 'regions_done',
   1.5, '0.1.0', '2024-06-30T12:00:03Z', 0.25, 1000, 100, NULL, NULL, NULL, 0.25, 1000, 100, NULL, NULL, NULL);
INSERT INTO views VALUES
  (1, 1, 0, 321.5, '[[1.0,0.0,0.0,0.1],[0.0,1.0,0.0,0.2],[0.0,0.0,1.0,0.3],[0.0,0.0,0.0,1.0]]', 960, 5, 1, 0.5, 20.0,
   0.0, 7.0, 0.5, 900, 90, 0.0012, 0.0034, 0.9);
