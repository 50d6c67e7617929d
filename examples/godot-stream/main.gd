# SPDX-License-Identifier: MIT
# Moves the hand and the vessels by a stream. On the command line:
#   --port=N      listens there and not at 9000
#   --write=FILE  writes a line of JSON for each frame: where the nodes are then
#   --until=STATE ends when the session has come to that state ("released") and all of the hand is where it was then
extends Spatial

const JOINT = "/wholehand/joint/"
const VESSEL = "/wholehand/vessel/"
const MOST_VESSELS = 16  # that are drawn: another program that sends could name any number

var _until = ""
var _file: File = null


func _ready() -> void:
	for argument in OS.get_cmdline_args():
		var parts = argument.split("=", true, 1)
		if argument.begins_with("--port="):
			$Stream.port = int(parts[1])
		elif argument.begins_with("--write="):
			_file = File.new()
			if _file.open(parts[1], File.WRITE) != OK:
				printerr("%s cannot be written" % parts[1])
				get_tree().quit(3)
		elif argument.begins_with("--until="):
			_until = parts[1]
	if $Stream.open():
		print("listens at %s port %d" % [$Stream.address, $Stream.port])
	else:
		get_tree().quit(3)
	$Stream.connect("frame", self, "_on_frame")


func _on_frame(number: int, values: Dictionary) -> void:
	var moved = []
	for address in values:
		var pose = values[address]
		if not _is_pose(pose):
			continue
		if address.begins_with(JOINT):
			var joint = address.substr(JOINT.length())
			if $Hand.has_joint(joint):
				$Hand.set_joint(joint, _place(pose), _turn(pose))
				moved.append($Hand.get_node(joint))
		elif address.begins_with(VESSEL) and address.ends_with("/pose"):
			var vessel = _vessel(address.substr(VESSEL.length()).get_base_dir())
			if not vessel:
				continue
			vessel.transform = Transform(Basis(_turn(pose).normalized()), _place(pose))
			moved.append(vessel)
	$Hand.stretch_bones()
	var told = values.get("/wholehand/state", [])
	var state = told[1] if told.size() == 2 and told[1] is String else ""
	if _file:
		_file.store_line(_line(number, state, moved))
	if state == _until and _until != "" and moved.size() > $Hand.names.size():
		get_tree().quit()


# Other programs may send to the port too.
func _is_pose(arguments: Array) -> bool:
	if arguments.size() != 7:
		return false
	for number in arguments:
		if not number is float or is_nan(number) or is_inf(number):
			return false
	return _turn(arguments).length_squared() > 0.5


func _place(pose: Array) -> Vector3:
	return Vector3(pose[0], pose[1], pose[2])


func _turn(pose: Array) -> Quat:
	return Quat(pose[3], pose[4], pose[5], pose[6])


# The stream says where a vessel is and not what it looks like: a disc lies at its base, and a rod stands on it.
# Null where there are as many as are drawn.
func _vessel(vessel: String) -> Spatial:
	for node in $Vessels.get_children():
		if node.get_meta("vessel") == vessel:
			return node
	if $Vessels.get_child_count() >= MOST_VESSELS:
		return null
	var added = Spatial.new()
	added.set_meta("vessel", vessel)  # a node's own name may not have every letter
	for size in [Vector2(0.03, 0.002), Vector2(0.002, 0.1)]:
		var mesh = MeshInstance.new()
		mesh.mesh = CylinderMesh.new()
		mesh.mesh.top_radius = size.x
		mesh.mesh.bottom_radius = size.x
		mesh.mesh.height = size.y
		mesh.translation = Vector3(0, 0.5 * size.y, 0)
		added.add_child(mesh)
	$Vessels.add_child(added)
	return added


# What the nodes say that this frame moved, and not what was received.
func _line(number: int, state: String, moved: Array) -> String:
	var joints = PoolStringArray()
	var vessels = PoolStringArray()
	for node in moved:
		if node.get_parent() == $Hand:
			joints.append("%s: %s" % [to_json(node.name), _numbers(node.global_transform)])
		else:
			vessels.append("%s: %s" % [to_json(node.get_meta("vessel")), _numbers(node.global_transform)])
	var line = "{\"tick\": %d, \"state\": %s, \"joints\": {%s}, \"vessels\": {%s}}"
	return line % [number, to_json(state), joints.join(", "), vessels.join(", ")]


func _numbers(pose: Transform) -> String:
	var turn = pose.basis.get_rotation_quat()
	var o = pose.origin
	var texts = PoolStringArray()
	for number in [o.x, o.y, o.z, turn.x, turn.y, turn.z, turn.w]:
		texts.append("%.12f" % number)  # float32 and a little more
	return "[%s]" % texts.join(", ")
