# SPDX-License-Identifier: MIT
# A hand that takes a vessel, lifts and tilts it, and puts it down, over and over. Put the place of your tracker or your mouse where
# this script has a path. On the command line:
#   --scene=FILE  another scene; its first vessel is taken
#   --grasps=N    ends when it has taken the vessel so many times and let go
extends Spatial

const PLUGIN = "res://libwholehand_godot.so"
const GAP = [0.0, 0.12]  # m: of the hand's own fingers, closed and open; of a gripper, the gripper's
const ROUND = 4.0  # s: come, close, lift and tilt, put down, open, go

var _wholehand
var _scene = "mixing_board"
var _grasps = 0
var _vessel = {}
var _seconds = 0.0
var _grip = 1.0  # how far the hand is open: it closes until the session says that it holds


func _ready() -> void:
	for argument in OS.get_cmdline_args():
		if argument.begins_with("--scene="):
			_scene = argument.trim_prefix("--scene=")
		elif argument.begins_with("--grasps="):
			_grasps = int(argument.trim_prefix("--grasps="))
	if not File.new().file_exists(PLUGIN):
		printerr("%s is not there: compile the plugin as docs/engines.md says" % PLUGIN)
		_end(3)
		return
	_wholehand = load("res://wholehand.gdns").new()
	# each of these prints its line where it is refused, and gives null
	if not _wholehand.open(_scene) or not _wholehand.session_open(GAP[0], GAP[1]):
		_end(2)
		return
	_vessel = _wholehand.vessels()[0]
	$Camera.translation.x = _vessel.place.x
	_show_vessel()
	_wholehand.session_start(_middle(), _turn(), GAP[1])


func _end(code: int) -> void:
	set_process(false)
	get_tree().quit(code)


# A gripper's forces are no business of this thread: it only says where the hand is, and draws what came of it.
func _process(seconds: float) -> void:
	_seconds += seconds
	var newest = _wholehand.session_newest()
	if newest == null:
		return
	var is_open = _phase() < 0.2 or _phase() > 0.85
	var is_held = newest.state in ["lift", "tilt", "maintain"]
	_grip = clamp(_grip + (seconds if is_open else (-seconds if not is_held else 0.0)), 0.2, 1.0)
	_wholehand.session_move(_middle(), _turn(), lerp(GAP[0], GAP[1], _grip))
	_show_hand()
	if is_held:
		$Vessels.get_child(0).transform = Transform(Basis(newest.vessel_turn), newest.vessel_place)
	if _grasps > 0 and newest.grasps >= _grasps and newest.state == "free":
		print("grasps %d, lost %d" % [newest.grasps, newest.lost])
		_wholehand.session_stop()
		get_tree().quit()


func _phase() -> float:
	return fmod(_seconds, ROUND) / ROUND


# 0 on the table, 1 lifted and tilted.
func _lifted() -> float:
	return smoothstep(0.4, 0.6, _phase()) * (1 - smoothstep(0.65, 0.8, _phase()))


func _middle() -> Vector3:
	var height = 0.5 * (_vessel.lowest + _vessel.highest)
	return _vessel.place + Vector3(0, height + 0.08 * _lifted(), 0)


func _turn() -> Quat:
	return Quat(Vector3(1, 0, 0), 0.6 * _lifted())


func _show_hand() -> void:
	var hand = _wholehand.session_hand()
	if hand == null:
		return
	for j in range($Hand.names.size()):
		$Hand.set_joint($Hand.names[j], hand.joints[j], hand.turns[j])
	$Hand.set_joint("XR_HAND_JOINT_WRIST_EXT", hand.wrist, hand.wrist_turn)
	$Hand.stretch_bones()


func _show_vessel() -> void:
	var mesh = MeshInstance.new()
	mesh.mesh = CylinderMesh.new()
	mesh.mesh.top_radius = 0.03
	mesh.mesh.bottom_radius = 0.03
	mesh.mesh.height = _vessel.highest - _vessel.lowest
	mesh.translation = Vector3(0, 0.5 * (_vessel.lowest + _vessel.highest), 0)
	var node = Spatial.new()
	node.translation = _vessel.place
	node.add_child(mesh)
	$Vessels.add_child(node)
