#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Long acceptance runs. Every step leaves its result in out/evidence, so an interrupted run continues where it stopped;
# rm -r out/evidence starts afresh. The figures, with their commands, go to docs/results/evidence.md.
# SACCADE_DATA: recorded sequences (../shared/data). SACCADE_FUZZ_MINUTES: per fuzz target (10).
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/common.sh
data="${SACCADE_DATA:-../shared/data}"
out=out/evidence
mkdir -p "$out"
failed=0

# step NAME COMMAND…: runs unless out/evidence/NAME.done is there; the command line and its outcome are kept beside it.
# Exit status 3 says that other machines are still at work.
step() {
  local name="$1"
  shift
  if [[ -f $out/$name.done ]]; then
    echo "  $name: done before"
    return 0
  fi
  echo "  $name: $*"
  printf '%s\n' "$*" >"$out/$name.command"
  local status=0
  "$@" >"$out/$name.log" 2>&1 || status=$?
  if ((status == 0)); then
    touch "$out/$name.done"
    return 0
  fi
  if ((status == 3)); then
    echo "  $name is not complete; see $out/$name.log, and run this again"
  else
    echo "  $name FAILED, see $out/$name.log"
  fi
  failed=1
  return 1
}

campaign() {  # NAME compare|benchmark OPTIONS…: on Slurm where it answers
  local name="$1"
  shift
  step "$name" scripts/evidence_campaign.py build/release/saccade "$out/$name" "$@"
}

fuse() {  # SEQUENCE TRACKING OPTIONS…
  local sequence="$1" tracking="$2" name="fuse_$1_$2"
  shift 2
  if [[ ! -d $data/$sequence ]]; then
    echo "  $name: skipped, $data/$sequence is not there"
    return
  fi
  step "$name" build/release/saccade fuse "$data/$sequence" --tracking "$tracking" --out "$out/$name" --json "$out/$name.json" "$@"
}

echo "Recorded sequences"
fuse rgbd_redkitchen forced
fuse rgbd_redkitchen icp
fuse rgbd_redkitchen hint
fuse rgbd_redkitchen rgbd
fuse rgbd_realsense_box forced
fuse rgbd_realsense_box icp
fuse rgbd_realsense_box rgbd
fuse rgbd_eyeinhand_shelfA forced
fuse rgbd_eyeinhand_shelfA icp
fuse rgbd_eyeinhand_shelfA rgbd

echo "Loops: ten rooms that the camera comes back to, twenty places that look alike"
loops() {  # NAME SCENE:SEED OPTIONS…
  local name="$1" scene="$2" frames="$out/frames_${2/:/_}"
  shift 2
  [[ -f $out/$name.done ]] || step "frames_${scene/:/_}" build/release/saccade --quiet scene sequence "$scene" --image-size 240,180 \
    --pose-noise off --out "$frames" --force
  step "$name" build/release/saccade --quiet fuse "$frames" --tracking "$tracking" --voxel-size 0.01 --no-mesh --no-pictures "$@" \
    --out "$out/run_${name//\//_}" --force --json "$out/$name.json"
}
for tracking in icp rgbd; do
  places="loops_$tracking"
  mkdir -p "$out/$places"
  for seed in 1 2 3 4 5 6 7 8 9 10; do
    loops "$places/open_$seed" "loop:$seed"
    loops "$places/loop_$seed" "loop:$seed" --loops end
    loops "$places/online_$seed" "loop:$seed" --loops online
  done
  for seed in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    loops "$places/alike_$seed" "alike:$seed" --loops end
  done
  step "loops_table_$tracking" /usr/bin/python3 scripts/evidence_loops.py "$out/$places"
done
for mode in off end; do
  step "surfels_loops_$mode" build/release/saccade --quiet surfels "$out/frames_loop_1" --tracking icp --loops "$mode" --out "$out/surfels_loops_$mode.ply" \
    --json "$out/surfels_loops_$mode.json"
done

echo "Poses beside colour images"
trajectory="$out/fuse_rgbd_redkitchen_icp/trajectory.txt"
if [[ -f $trajectory ]]; then
  scripts/install_packages.sh program tests
  configure release -DSACCADE_BUILD_BENCH=ON && compile release color_agreement >"$out/build_color_agreement.log" || failed=1
  step color_agreement build/release/bench/color_agreement "$data/rgbd_redkitchen" "$trajectory"
else
  echo "  skipped, $trajectory is not there"
fi

echo "Tracking by colours and depths: hand-held cameras before the scenes of surfels, two ways each, ICP beside it"
for sequence in workshop-1 workshop-2 desk magazines-1 magazines-2; do
  for seed in 1 2; do
    frames="$out/sequences/$sequence-$seed"
    mkdir -p "$out/sequences"
    step "sequence_${sequence}_$seed" build/release/saccade --quiet --seed "$seed" scene sequence "$sequence" --frames 300 --pose-noise off \
      --out "$frames" --force
    for tracking in icp rgbd; do
      name="track_${sequence}_${seed}_$tracking"
      step "$name" build/release/saccade --quiet fuse "$frames" --tracking "$tracking" --no-mesh --no-pictures --force --out "$out/$name" \
        --json "$out/$name.json"
    done
  done
done
step sequence_desk_fast build/release/saccade --quiet scene sequence desk --frames 120 --image-size 640,480 --pose-noise off \
  --out "$out/sequences/desk-fast" --force
for tracking in icp rgbd; do
  step "track_desk_fast_$tracking" build/release/saccade --quiet fuse "$out/sequences/desk-fast" --tracking "$tracking" --no-mesh \
    --no-pictures --force --out "$out/track_desk_fast_$tracking" --json "$out/track_desk_fast_$tracking.json"
done

echo "View evaluation: 960 poses, 640×480, a forgotten sphere of 0.2 m on a table"
map="$out/fuse_rgbd_redkitchen_forced/map.sacmap"
if [[ -f $map ]]; then
  for run in 1 2 3; do
    step "nbv_redkitchen_$run" build/release/saccade nbv "$map" --poi="${SACCADE_NBV_POI:--0.47,-0.01,1.78}" --radius 0.2 --forget \
      --json "$out/nbv_redkitchen_$run.json"
  done
else
  echo "  skipped, $map is not there"
fi

echo "Tables of the thesis"
tables=(2.9 2.10)
if [[ -d $data/hand_polhemus ]]; then
  tables=(2.2 2.3 2.4 2.5 2.6 "${tables[@]}" --hands "$data/hand_polhemus")
else
  echo "  without Tables 2.2 to 2.6, $data/hand_polhemus is not there"
fi
step reproduce build/release/saccade --quiet reproduce 2.1 2.12 2.21 3.23 3.24 "${tables[@]}" --out "$out/figures" --force \
  --json "$out/reproduce.json"
step reproduce_views build/release/saccade --quiet reproduce 2.16 2.17 2.18 2.19 2.20 3.16 3.18 3.19 3.20 3.21 3.22 4.20 4.21 \
  --out "$out/figures_of_views" --force --json "$out/reproduce_views.json"

echo "Explorations: ten seeds, noise on"
scenes="$(build/release/saccade scene list --json - | /usr/bin/python3 -c 'import json, sys; print(",".join(s["name"] for s in json.load(sys.stdin)["result"]["scenes"] if not s["name"].endswith("-before")))')"
campaign compare compare --scenes "$scenes,clutter:1" --strategies sphere,random --seeds 1-10 --max-views 12 --equal-views --robot free

echo "Attention beside others: the arm, ten seeds in the tabletop scenes, thirty scenes of random clutter, noise on"
campaign attention compare --scenes tabletop-1,tabletop-2,tabletop-3,tabletop-4 \
  --strategies attention,standard,sphere,random-contours,oracle --robot comau --seeds 1-10 --max-views 5
campaign attention_clutter compare --scenes clutter:101-130 --strategies attention,standard,sphere,oracle --robot comau --seeds 1 --max-views 5

echo "Published protocols: stand-ins, and the meshes that are there, all strategies; tables go to docs/results/benchmark.md"
scripts/stanford_meshes.sh "$out/stanford" >/dev/null || echo "  protocols on Stanford models: only with those that are there"
step benchmark env SACCADE_DATA="$data" STANFORD="$out/stanford" scripts/evidence_benchmark.py build/release/saccade "$out" docs/results/benchmark.md

echo "The planner beside the oracle, baselines and sphere, on Slurm where it answers; figures go to docs/results/planner.md"
step planner scripts/evidence_planner.py build/release/saccade "$out/planner" docs/results/planner.md

echo "The headline figures: a hundred scenes, ten seeds, five strategies; on Slurm where it answers, else here, some 18 hours on two cores"
step headline scripts/evidence_headline.py build/release/saccade "$out/headline" docs/results/headline.md
echo "Explorations on surfels beside those on a volume; the table goes to docs/guides/exploration.md"
step maps scripts/evidence_maps.py build/release/saccade "$out/maps"

echo "Updates after a user's task: ten seeds, noise on"
for scene in bottle jug; do
  for when in viewpoints motion; do
    for seed in 1 2 3 4 5 6 7 8 9 10; do
      name="update_${scene}_${when}_$seed"
      step "$name" build/release/saccade --quiet --seed "$seed" update --scene "$scene" --fuse-when "$when" --robot comau --no-pictures \
        --force --out "$out/update" --json "$out/$name.json"
    done
  done
done

echo "Arms beside FCL: 100,000 configurations each"
scripts/install_packages.sh program tests
configure release -DSACCADE_BUILD_TESTS=ON && compile release parity unit_io_sessions unit_surfel golden >"$out/build_parity.log" || failed=1
step arm_collision env SACCADE_COLLISION_CASES=100000 build/release/tests/parity '--gtest_filter=ArmCollision*'

echo "Surfels of rendered scenes, segmented: all frames"
for scene in workshop-1 workshop-2 desk magazines-1 magazines-2; do
  close_ups=()
  case $scene in
    workshop-1) close_ups=(fig-4.5 fig-4.9) ;;
    workshop-2) close_ups=(fig-4.6) ;;
    magazines-1) close_ups=(fig-4.7) ;;
    magazines-2) close_ups=(fig-4.8) ;;
  esac
  step "surfels_$scene" build/release/saccade --quiet reproduce 4.1 4.3 4.10 4.11 "${close_ups[@]}" --scene "$scene" \
    --out "$out/surfels_$scene" --force --json "$out/surfels_$scene.json"
done

echo "The same with another way and noise"
for scene in workshop-1 workshop-2 desk magazines-1 magazines-2; do
  step "surfels_seed_2_$scene" build/release/saccade --quiet --seed 2 reproduce 4.1 4.10 4.11 --scene "$scene" \
    --out "$out/surfels_seed_2_$scene" --force --json "$out/surfels_seed_2_$scene.json"
done

echo "Surfels with automatic gain and exposure compensation: all frames, three times over"
for scene in magazines-1 magazines-2; do
  step "surfels_gain_$scene" build/release/saccade --quiet reproduce 4.gain --scene "$scene" --json "$out/surfels_gain_$scene.json"
done

echo "Surfels: 100,000 frames of the same spot"
step surfel_growth env SACCADE_SURFEL_FRAMES=100000 build/release/tests/unit_surfel '--gtest_filter=*FramesOfTheSameSpot*'

echo "Surfels: colour edges of recorded frames"
if [[ -d $data/rgbd_redkitchen ]]; then
  step surfel_picture build/release/saccade surfels "$data/rgbd_redkitchen" --out "$out/surfels.ply" --mode-filter both \
    --picture "$out/surfels.png"
  step surfel_sharpness env SACCADE_SHARPNESS_FRAMES=200 build/release/tests/golden '--gtest_filter=SurfelSharpness*'
else
  echo "  skipped, $data/rgbd_redkitchen is not there"
fi

echo "Motions of the arm beside FCL: ten seeds, all built-in scenes"
step motion_planning env SACCADE_PLANNING_SEEDS=10 build/release/tests/parity '--gtest_filter=MotionPlanning*'

echo "A simulated cell whose devices are processes of their own"
for what in compare faults update; do
  step "cell_$what" /usr/bin/python3 scripts/evidence_cell.py "$what" "$out/cell_$what"
done

echo "Annotation: simulated annotators on labelled clouds"
clouds="$data/mosd_labelled/learn"
if [[ -d $clouds ]]; then
  step annotation_control_points build/release/saccade --quiet annotate "$clouds" --simulate "$clouds" --clicks 6 \
    --json "$out/annotation_control_points.json"
  step annotation_rectangles build/release/saccade --quiet annotate "$clouds" --simulate "$clouds" --clicks 6 --method rectangle \
    --json "$out/annotation_rectangles.json"
  step annotation_best_rectangles build/release/saccade --quiet annotate "$clouds" --simulate "$clouds" --clicks 6 \
    --method best-rectangle --json "$out/annotation_best_rectangles.json"
else
  echo "  skipped, $clouds is not there"
fi

echo "Annotation: simulated annotators in made rooms and streets"
for kind in room street; do
  mkdir -p "$out/scans_$kind"
  for seed in 1 2 3 4 5 6; do
    step "scan_${kind}_$seed" build/release/saccade --quiet scene scan "$kind:$seed" --step 0.35 --out "$out/scans_$kind/$kind-$seed.pcd"
  done
  step "annotation_$kind" build/release/saccade --quiet annotate "$out/scans_$kind" --simulate "$out/scans_$kind" --clicks 6 \
    --json "$out/annotation_$kind.json"
done

echo "Annotation sessions: a thousand processes killed while they annotate"
step annotation_kills env SACCADE_KILL_CASES=1000 build/release/tests/unit_io_sessions '--gtest_filter=AnnotationSessionKilled*'

echo "Maps larger than the memory: a building of 40 × 30 × 6 m at 1 cm, and a tenth of the memory"
configure release -DSACCADE_BUILD_BENCH=ON && compile release large_map >"$out/build_large_map.log" || failed=1
step large_map_ratio build/release/bench/large_map ratio 3
step large_map_frames build/release/bench/large_map frames "$out/building" &&
  step large_map_building build/release/saccade --quiet fuse "$out/building" --tracking forced --voxel-size 0.01 --map-memory 640MiB \
    --no-mesh --no-pictures --out "$out/large_map_building" --json "$out/large_map_building.json" &&
  step large_map_memory /usr/bin/python3 -c "
import json, sys
result = json.load(open('$out/large_map_building.json'))['result']
print(result['frames'], result['map']['bytes'], result['paging'], result['peak_rss_bytes'])
sys.exit(result['peak_rss_bytes'] > 1 << 30)"

echo "The page: its times, and the annotation of ten million points"
step browser_times scripts/web.sh test --project times --no-deps
step browser_large env SACCADE_LARGE=1 scripts/web.sh test large

echo "Tests that many seeds, scenes or frames make true, and clang-tidy without what it knows to be clean"
configure release -DSACCADE_BUILD_TESTS=ON -DSACCADE_BUILD_BENCH=ON && compile release >>"$out/build_tests.log" || failed=1
step floors ctest --test-dir build/release -L floors --output-on-failure
for program in build/release/tests/*; do
  [[ -f $program && -x $program ]] || continue
  [[ -n "$("$program" --gtest_list_tests --gtest_filter='*Evidence.*' | grep '^  ')" ]] || continue
  step "tests_$(basename "$program")" "$program" '--gtest_filter=*Evidence.*'
done
step tidy env SACCADE_TIDY_CACHE=off scripts/tidy.sh

echo "Fuzzing"
{ configure asan-ubsan && compile asan-ubsan tests/fuzz/all; } >"$out/build_fuzzers.log" || failed=1
for source in tests/fuzz/fuzz_*.cpp; do
  [[ -f $source ]] || continue
  target="$(basename "$source" .cpp)"
  step "$target" scripts/fuzz.sh "$((60 * ${SACCADE_FUZZ_MINUTES:-10}))" "$target"
done

if [[ -x build/release/saccade-ros1 ]]; then
  step ros1_node /usr/bin/python3 scripts/evidence_ros.py build/release 10
else
  echo "  ros1_node: skipped, saccade-ros1 is not built (scripts/install_packages.sh ros)"
fi
step python_costs env PYTHONPATH=build/release/python /usr/bin/python3 scripts/evidence_python.py
step python_sanitized scripts/python_sanitized.sh
step packages_made scripts/package.sh &&
  step packages_clean_root env SACCADE_CLEAN_ROOT=1 tests/package/debs.sh . build/release/packages "$out/debs"

/usr/bin/python3 scripts/evidence_table.py "$out" docs/results/evidence.md || failed=1
echo "The figures are in docs/results/evidence.md"
exit "$failed"
