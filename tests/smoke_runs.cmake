# SPDX-License-Identifier: Apache-2.0
# Command line tests for AddressSanitizer: each command once, and errors in its input. The rest of
# tests/cli goes through the same code, which the unit and property tests cover under the sanitizers.
set(smoke_tests
  Annotate.AFewClicksLabelAScene
  AnnotateSession.AScriptLabelsAScene
  Attend.FindsWhatTheLibraryFinds
  BadInput.*
  BenchmarkCommand.ListsItsProtocols
  CompareCommand.GoesOnWhereItStopped
  ExploreCommand.GoesFromViewToView
  ExploreProcesses.ACameraAndARobotThatAreProgramsBuildAMap
  Filter.RemovesWhatTheLibraryRemoves
  Fuse.ForcedPosesGiveAllResults
  Nbv.InfoDescribesTheProgramTheMapAndTheRun
  Nbv.RanksTheViewSphereAsTheLibraryDoes
  Reproduce.TablesStandBesideTheThesis
  RobotCommand.SaysWhatItUnderstood
  RobotReach.GoesByWhatItIsTold
  Sample.IsSeededAndKeepsOtherFiles
  SceneCommand.DrawsAScene
  SceneSequence.IsAFolderOfFramesWithTheirTruth
  Score.IsWhatCanBeWorkedOutByHand
  Segment.LabelsACloudAndSaysHowSalientItsPartsAre
  ShowCommand.ShowsARunWhileItGoesOn
  Surfels.BothGivesTheModesAndTheAverages
  UpdateCommand.LooksAgainWhereABottleWasPutDown)
list(JOIN smoke_tests ":" smoke_runs)
