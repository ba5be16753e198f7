// Reads a log of lcm-logger with the types that lcm-spy finds on its class path, in lcm-spy's own way, and prints every
// event: "<channel> <type>", and for each body of a response "wrench <utime> <body_id> <fx> <fy> <fz>". Exit code 1: a
// message whose type is not on the class path.
import java.io.DataInput;
import java.io.EOFException;
import java.nio.ByteBuffer;

import lcm.lcm.LCMDataInputStream;
import lcm.logging.Log;
import lcm.spy.LCMTypeDatabase;

public class PrintLog {
  public static void main(String[] arguments) throws Exception {
    LCMTypeDatabase types = new LCMTypeDatabase();
    Log log = new Log(arguments[0], "r");
    while (true) {
      Log.Event event;
      try {
        event = log.readNext();
      } catch (EOFException end) {
        return;
      }
      Class<?> type = types.getClassByFingerprint(ByteBuffer.wrap(event.data).getLong());
      if (type == null) {
        System.err.println(event.channel + ": no type on the class path has this message's fingerprint");
        System.exit(1);
      }
      System.out.println(event.channel + " " + type.getName());
      Object message = type.getConstructor(DataInput.class).newInstance(new LCMDataInputStream(event.data));
      if (!(message instanceof buoyancy.body_wrenches_t)) continue;
      buoyancy.body_wrenches_t answer = (buoyancy.body_wrenches_t) message;
      for (buoyancy.body_wrench_t body : answer.bodies) {
        System.out.println(
            "wrench " + answer.utime + " " + body.body_id
                + " " + body.force[0] + " " + body.force[1] + " " + body.force[2]);
      }
    }
  }
}
