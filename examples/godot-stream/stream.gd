# SPDX-License-Identifier: MIT
# Receives a session of `wholehand live --stream osc://127.0.0.1:9000` and gives each frame that is complete.
extends Node

# `number`: of the tick. `values`: arguments by address, as docs/stream.md lists them.
signal frame(number, values)

const Osc = preload("res://osc.gd")
const ROOM = 1048576  # bytes: for what comes while the engine loads something; Godot's own 65536 hold a sixth of a second

export var port = 9000
export var address = "127.0.0.1"  # "*" listens to other machines too

var _socket = PacketPeerUDP.new()
var _number = -1
var _values = {}


# Whether it listens; the port of another program cannot be had.
func open() -> bool:
	if _socket.listen(port, address, ROOM) == OK:
		return true
	printerr("port %d of %s cannot be opened: another program may listen there; choose another with --port=N" % [port, address])
	return false


func close() -> void:
	_socket.close()


func _process(_seconds) -> void:
	while _socket.is_listening() and _socket.get_available_packet_count() > 0:
		for message in Osc.read(_socket.get_packet()):
			_take(message[0], message[1])


# Every datagram says first of which frame it is, and the last message of a frame says that it is over. What a lost datagram had is
# absent from its frame; the next frame has it.
func _take(message_address: String, arguments: Array) -> void:
	match message_address:
		"/wholehand/frame":
			if not arguments.empty() and arguments[0] is int and arguments[0] != _number:
				_number = arguments[0]
				_values = {}
		"/wholehand/end":
			if _number >= 0:
				emit_signal("frame", _number, _values)
			_number = -1
		_:
			_values[message_address] = arguments
