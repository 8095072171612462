"""The live system: data from the network in, tracks, alarms and a screen out."""
